"""Motions for other programs and for robots: one format per file."""
