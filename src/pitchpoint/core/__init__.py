"""What knows nothing of gears: programs that are kept, roots, pages, and what became of a solve."""
