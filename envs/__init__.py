"""Environments: one file a task; `analytic` in closed form, the others simulated by `mujoco`."""
