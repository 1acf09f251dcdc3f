"""Runs: analyses of a case computed part by part, kept on disk, and read again."""
