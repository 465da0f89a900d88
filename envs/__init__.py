"""Worlds: each file is one task, and `physics` steps those that MuJoCo simulates."""
