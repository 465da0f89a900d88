"""Identify a robot: from a log to a MuJoCo model with intervals, and how to move it for the log.

from hybrid_rl import identify

arm = identify.read("arm.xml", "params.yaml")
plan = identify.excite(arm, "fisher", seconds=4, limits=0.8)
log = identify.play(arm, plan, MyRobot())
found = identify.fit(arm, [log], check=second)
identify.write(found, "identified")
"""

from hybrid_rl.tools.identify.excitation import excite as excite
from hybrid_rl.tools.identify.fitting import fit as fit
from hybrid_rl.tools.identify.log import Log as Log
from hybrid_rl.tools.identify.log import load as load
from hybrid_rl.tools.identify.playing import play as play
from hybrid_rl.tools.identify.report import write as write
from hybrid_rl.tools.identify.system import System as System
from hybrid_rl.tools.identify.system import read as read
