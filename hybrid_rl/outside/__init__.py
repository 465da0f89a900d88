"""Decisions and rows of worlds that step outside of a compiled program.

    Gymnasium   host_loop (sending)                        copies step beside the program
    a robot     actor -> rows -> robot_loop -> parameters  two processes (robot_process)
    your loop   run.online -> rows -> learner              one process

`acting` decides in all of them; `learner` learns from rows.
"""
