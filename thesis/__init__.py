"""The thesis beside the library: studies of its figures, their scripts and their tests.

It stands on the library as a user's own project would, and the library never imports it. In a
checkout it is the folder `thesis/`; everywhere it is imported as `hybrid_rl.thesis`.
"""
