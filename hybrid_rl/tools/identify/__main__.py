"""Identify a robot: from a log to a MuJoCo model with intervals, and a motion for the log.

    python -m hybrid_rl.identify model=arm.xml parameters=params.yaml
    python -m hybrid_rl.identify model=arm.xml parameters=params.yaml excite=fisher out=plan.npz
    python -m hybrid_rl.identify model=arm.xml parameters=params.yaml play=plan.npz robot=mybot:Arm out=log.npz
    python -m hybrid_rl.identify model=arm.xml parameters=params.yaml log=log.npz check=second.npz

Without more than model and parameters it says what a motion could show, and what it could not.
excite= plans one; play= plays it, and stops the robot at its limits; log= fits the parameters and
writes a model, intervals, ranges for episode.randomise.elements and a picture into the folder out.

parameters is a YAML file with a line for each unknown number, joint.elbow.damping: [0.1, 1] say; the
how-to "Identify a robot" has an example. A log holds t [T], ctrl [T, nu] and q [T, nq].
"""  # noqa: E501

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

from typing import Any

from hybrid_rl import UsageError, arguments, command
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.tools.identify import excitation, fitting, log, playing, report
from hybrid_rl.tools.identify.system import System, read

HOW = (*excitation.SIGNALS, "fisher")
ARGUMENTS = (
    arguments.Argument("model", "", "its MJCF file", needed="model=FILE.xml"),
    arguments.Argument("parameters", "", "the unknown ones", needed="parameters=FILE.yaml"),
    arguments.Argument("excite", "", " or ".join(HOW), arguments.one_of("", *HOW)),
    arguments.Argument("seconds", 4.0, "of the motion", arguments.number(0.1)),
    arguments.Argument("limits", 0.8, "share of each limit that it uses", arguments.number(0.0)),
    arguments.Argument("seed", 0, "of random numbers", arguments.whole(least=0)),
    arguments.Argument("play", "", "a plan, PLAN.npz, to be played on robot="),
    arguments.Argument("robot", "", "MODULE:CLASS, as env.make of task=robot"),
    arguments.Argument("log", "", "a log, or several with commas between them"),
    arguments.Argument("check", "", "another log, which is not fitted"),
    arguments.Argument("starts", fitting.STARTS, "of the fit", arguments.whole()),
    arguments.Argument("out", "", "plan.npz, log.npz, or with log= a folder"),
)


def prospect(system: System, plan: excitation.Plan) -> list[str]:
    """What a log of a plan will show, and what it will not."""
    width = max(map(len, system.names))
    text = [
        f"{name:{width}}  {value:10.5g}  in [{low:.5g}, {high:.5g}], +- "
        + (f"{200 * std:.2g}%" if log else f"{2 * std * (high - low):.2g}")
        for name, value, low, high, std, log in zip(
            *(system.names, system.nominal, system.low, system.high),
            *(plan.deviations, system.logs),
            strict=True,
        )
    ]
    text += [f"not separable: {each.text}" for each in plan.weak]
    text.append(f"{plan.t[-1]:.1f} s, {plan.reach:.0%} of the nearest limit")
    return text


def main() -> None:
    """The command."""
    given: Any = arguments.read(__doc__, ARGUMENTS)[0]
    if [bool(given[name]) for name in ("excite", "play", "log")].count(True) > 1:
        raise UsageError("excite, play, log: give one of them")
    system = read(given["model"], given["parameters"])
    if given["log"]:
        logs = [log.load(each, system) for each in given["log"].split(",")]
        check = log.load(given["check"], system) if given["check"] else None
        found = fitting.fit(system, logs, check, given["starts"], given["seed"])
        folder = report.write(found, given["out"] or "identified")
        print(*report.lines(found), f"see {folder}/report.png", sep="\n")
    elif given["play"]:
        out = arguments.output("out", given["out"] or "log.npz", [".npz"])
        plan = log.load(given["play"], system)
        playing.play(system, plan, Robot(make=given["robot"]).made()).write(out)
        print(f"played {plan.t[-1]:.1f} s; see {out}")
    else:
        how = given["excite"] or "sines"
        plan = excitation.excite(system, how, given["seconds"], given["limits"], given["seed"])
        print(*prospect(system, plan), sep="\n")
        if given["excite"]:
            out = arguments.output("out", given["out"] or "plan.npz", [".npz"])
            plan.write(out)
            print(f"see {out}")


if __name__ == "__main__":
    command.run(main)
