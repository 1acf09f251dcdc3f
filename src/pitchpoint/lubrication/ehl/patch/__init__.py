"""Contacts of finite length solved: pressure and film over a patch, of a line with ends or of an ellipse."""
