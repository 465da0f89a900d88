"""Learners beside a world that a program of the user's steps."""
