"""Tools that stand on the library, as a user's project would.

`hybrid_rl.NAME` is `hybrid_rl.tools.NAME` on the command line; the library imports no tool.
"""
