"""Contact maps: objects found, mapped and localised by touch (figures 5-2 to 5-7).

    python -m hybrid_rl.figures study=contact_maps view=map runs="runs/contact_plane/*/*"
    python -m hybrid_rl.figures study=contact_maps view=pose runs="runs/contact_plane/*/*"
    python -m hybrid_rl.figures study=contact_maps view=frames runs=DIR times=1,2,4,8

view=map     figures 5-2, 5-5 a b, 5-6: maps of experiment=thesis/fig_5_2 or fig_5_6 at `times`, of
             the first trial, and over time how many objects were touched, how much of their
             outlines, and intersection over union; map_out=FILE keeps the map of trial `trial`
view=pose    figures 5-3, 5-4, 5-5 c d, 5-7: position and angle errors of experiment=thesis/fig_5_4
             or fig_5_7 at `times`, and from when on each trial is within 3 cm and 0.1 rad; by sign
             tests the others are compared with the first run, of the same seeds
view=frames  figures 5-4, 5-6, 5-7: path and belief of trial `trial` of one run at `times`: maps by
             outline and probability, poses by particles and the density of the target
view=absence claim on the lack of contact: entropy of the pose after all measurements, after the
             contacts alone and after the others alone, and the error of the mean pose, by the first
             run's particles with `belief.kind=metropolis`; the entropy is that of a resolution of
             3 mm, at least the dashed line

IQM and 95% band over trials; shares with Wilson's 95% interval.
"""

from typing import Annotated, Any

from hybrid_rl.cli.arguments import one_of, whole
from hybrid_rl.thesis.studies import contact_frames, contact_maps_picture, contact_poses
from hybrid_rl.thesis.studies.numbers import rounded

DRAWN = {"pose": contact_poses.draw_poses, "absence": contact_poses.draw_absence}
LINES = {
    "map": contact_maps_picture.lines,
    "pose": contact_poses.lines,
    "frames": contact_frames.lines,
    "absence": contact_poses.absence_lines,
}


def figure(
    view: Annotated[str, ", ".join(LINES), one_of(*LINES)] = "map",
    runs: Annotated[str, "run folders; a pattern in quotes"] = "",
    times: Annotated[str, "of the maps and of the numbers [s], with commas between"] = "",
    trial: Annotated[int, "of map_out and of view=frames", whole(0)] = 0,
    names: Annotated[str, "of runs: method or folder", one_of("method", "folder")] = "method",
    map_out: Annotated[str, "of view=map: file for a learned map, .npz; empty: none"] = "",
) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers of one view."""
    views = {
        "map": lambda: contact_maps_picture.maps(runs, names, times, trial, map_out),
        "pose": lambda: contact_poses.poses(runs, names, times),
        "frames": lambda: contact_frames.frames(runs, times, trial),
        "absence": lambda: contact_poses.absence(runs, times),
    }
    figure, numbers = views[view]()
    return figure, {"view": view, **rounded(numbers)}


def draw(numbers: dict[str, Any]) -> Any:
    """The picture of numbers from a JSON of view=pose or view=absence.

    Raises:
        KeyError: for other views, whose JSON has no maps.
    """
    return DRAWN[numbers["view"]](numbers)


def summary(numbers: dict[str, Any]) -> list[str]:
    """The lines of one view."""
    return LINES[numbers["view"]](numbers)
