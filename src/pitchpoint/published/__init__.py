"""Published cases: a folder each, with what only its print needs; nothing of it enters the library."""
