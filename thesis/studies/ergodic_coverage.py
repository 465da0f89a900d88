"""Ergodic coverage: time averages of trajectories against the target distribution.

    python -m hybrid_rl.figures study=ergodic_coverage view=control out=fig_6_1.png

view=control    figure 6-1: KL-ergodic and Fourier control of a point mass. D(p || q) [nat], target
                p, time average q, over seeds; the picture has the median and the quartiles
view=average    figure 6-2: four estimates of the time average of one trajectory, and their total
                variation (half the absolute difference) to the target
view=marginals  of task=: marginals of target and time average, in any dimension, and the total
                variation of each
view=cost       time of one plan [ms] of the quadcopter over the dimension of the search space

The summary has interquartile means over seeds with 95% bands.
"""

from collections.abc import Callable
from time import perf_counter
from typing import Annotated, Any

import numpy as np

from hybrid_rl.analysis.curves import plural, spread
from hybrid_rl.analysis.style import blank, legend_below, line_styles, plain_log
from hybrid_rl.cli.arguments import one_of, whole
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.thesis.studies.numbers import rounded
from hybrid_rl.thesis.studies.time_averages import (
    GRID,
    VARIANCE,
    averages,
    divergences,
    grid,
    histogram,
    log_density,
    objective,
    on_grid,
    trajectories,
)

VIEWS = ("control", "average", "marginals", "cost")
FIGURE = ("experiment=thesis/fig_6_1",)
NAMES = {"kle3": "KL-ergodic", "fourier_ergodic": "Fourier", "kle3_jensen": "Jensen's bound"}
DIMENSIONS = (2, 4, 5, 6, 9, 12)  # of view=cost
COORDINATES = {  # task -> names of its search coordinates
    "quadcopter_se3": [*(f"v_{i} [m/s]" for i in "xyz"), *(f"w_{i} [rad/s]" for i in "xyz")],
    "point_mass": ["x", "y"],
    "cart_double_pendulum": ["position on the rail [m]"],
    "no_dynamics": ["position on the rail [m]"],
}
MOST = 5**6  # Fourier coefficients that fit in memory
BRIGHTEST = 8.0  # density, of mean one, at the end of the colour map


def figure(
    view: Annotated[str, ", ".join(VIEWS), one_of(*VIEWS)] = "control",
    task: Annotated[str, "of view=marginals"] = "quadcopter_se3",
    seeds: Annotated[int, "trajectories that are compared", whole()] = 10,
    steps: Annotated[int, "decisions of each trajectory", whole()] = 400,
) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers of one view."""
    views: dict[str, Callable[[], tuple[Any, dict[str, Any]]]] = {
        "control": lambda: control(seeds, steps),
        "average": lambda: average(steps),
        "marginals": lambda: marginals(task, seeds, steps),
        "cost": cost,
    }
    figure, numbers = views[view]()
    return figure, {"view": view, **rounded(numbers)}


def summary(numbers: dict[str, Any]) -> list[str]:
    """The lines of one view."""
    view = numbers["view"]
    if view == "control":
        each = {name: numbers[algo] for algo, name in NAMES.items()}
        return [
            f"{name}: D(p || q) {spread(np.array(one['divergence'])[:, -1])} nat "
            f"after {one['t'][-1]:g} s"
            for name, one in each.items()
        ]
    if view == "average":
        negative = numbers["negative_mass"]
        return [
            f"{name}: total variation to the target {away:.3g}, "
            f"negative mass {abs(negative[name]):.3g}"
            for name, away in numbers["total_variation_to_target"].items()
        ]
    if view == "marginals":
        return [
            f"{name}: total variation of target and time average {spread(np.array(each))}"
            for name, each in numbers["total_variation"].items()
        ]
    repeats = numbers["repeats"]
    return [
        f"{NAMES[algo]}, {v} dimensions: {1e3 * seconds:.3g} ms a plan (median of {repeats})"
        for algo in ("kle3", "fourier_ergodic")
        for v, seconds in zip(*numbers[algo].values(), strict=True)
    ]


def control(seeds: int, steps: int) -> tuple[Any, dict]:
    """Trajectories and time averages of two controllers, and divergences of three over time."""
    figure, panels = _subplots(2, 3)
    numbers: dict[str, Any] = {"variance": VARIANCE, "seeds": seeds}
    for panel in panels[:, 2]:
        panel.remove()
    over_time = figure.add_subplot(panels[0, 0].get_gridspec()[:, 2])
    recorded = np.unique([*range(9, steps, 10), steps - 1])  # every tenth decision, and the last
    styles = line_styles(NAMES)
    for i, (algo, name) in enumerate(NAMES.items()):
        began = perf_counter()
        run = build(load([*FIGURE, f"algo={algo}", f"episode.steps={steps + 1}"]))
        x = trajectories(run, seeds, steps)
        each = np.array([divergences(run, one) for one in x])
        t = run.agent.spec.dt * np.arange(1, steps + 1)
        numbers[algo] = {"t": t[recorded], "divergence": each[:, recorded]}
        print(f"{name}: {plural(seeds, 'seed')}, {perf_counter() - began:.0f} s", flush=True)
        low, middle, high = np.quantile(each, [0.25, 0.5, 0.75], axis=0)
        style = styles[algo] | {"marker": None}
        over_time.semilogy(t, middle, label=name, **style)
        over_time.fill_between(t, low, high, color=style["color"], alpha=0.2, lw=0)
        if i < 2:
            density = on_grid(np.exp(log_density(run, grid())))
            _show(panels[i][0], density, f"target, trajectory: {name}")
            panels[i][0].plot(*x[0].T, color="#D55E00", lw=0.7)
            _show(panels[i][1], averages(x[0])["sum of Gaussians (6.1)"], "its time average")
    over_time.set(xlabel="Time [s]", title=f"D(p || q) [nat], {seeds} seeds")
    plain_log(over_time.yaxis)
    legend_below(over_time)
    _colour_bar(figure, panels[:, :2])
    return figure, numbers


def average(steps: int) -> tuple[Any, dict]:
    """One trajectory of KL-ergodic control, and four estimates of its time average."""
    run = build(load([*FIGURE, f"episode.steps={steps + 1}"]))
    x = trajectories(run, 1, steps)[0]
    target = on_grid(np.exp(log_density(run, grid())))
    pictures = averages(x)
    figure, panels = _subplots(2, 3)
    trajectory, *others = panels.flat
    _show(trajectory, np.full((GRID, GRID), np.nan), "trajectory")
    trajectory.plot(*x.T, color="#D55E00", lw=0.8)
    for panel, (title, density) in zip(others, {"target": target, **pictures}.items(), strict=True):
        _show(panel, density, title)
    _colour_bar(figure, panels)
    away = {name: float(np.abs(each - target).mean() / 2) for name, each in pictures.items()}
    negative = {name: float(-each[each < 0].sum() / each.size) for name, each in pictures.items()}
    return figure, {"total_variation_to_target": away, "negative_mass": negative, "x": x}


def marginals(task: str, seeds: int, steps: int) -> tuple[Any, dict]:
    """Marginals of target and time average, a panel per coordinate of the search space."""
    import jax

    run = build(load([f"task={task}", "algo=kle3", f"episode.steps={steps + 1}"]))
    domain = objective(run).domain
    low, high = domain.low, domain.high
    s = np.asarray(domain.sample(100_000, jax.random.key(0)))
    p = np.asarray(jax.nn.softmax(log_density(run, s)))
    x = trajectories(run, seeds, steps)
    figure, panels = _subplots(-(-len(low) // 3), min(3, len(low)))
    names = [f"observation {number}" for number in domain.coordinates]
    names = COORDINATES.get(task, names)
    shares: dict[str, list[np.ndarray]] = {"target": [], "time": []}
    variation = {}
    for j, (panel, name) in enumerate(zip(panels.flat, names, strict=False)):
        edges = np.linspace(low[j], high[j], 31)
        target = histogram(s[:, j], edges, p)
        each = np.array([histogram(one[:, j], edges) for one in x])
        time = histogram(x[:, :, j].ravel(), edges)
        for share, label in ((target, "target"), (time, "time average of the trajectories")):
            panel.stairs(share, edges, label=label, lw=1.4)
        panel.set(xlabel=name, ylabel="Density")
        shares["target"].append(target)
        shares["time"].append(time)
        variation[name] = 0.5 * np.abs(each - target).sum(1) * (edges[1] - edges[0])
    for panel in list(panels.flat)[len(low) :]:
        panel.remove()
    legend_below(panels[-1][0])
    figure.suptitle(f"{task}: marginals of {seeds} seeds, {steps} decisions")
    numbers = {"task": task, "seeds": seeds, "steps": steps, "low": low, "high": high}
    return figure, {**numbers, **shares, "total_variation": variation}


def cost(repeats: int = 9) -> tuple[Any, dict]:
    """Time of one plan of the quadcopter over the dimension of the search space."""
    numbers: dict[str, Any] = {"horizon": 5, "samples": 100, "modes": 5, "repeats": repeats}
    order = [12, 13, 14, 15, 16, 17, 0, 1, 2, 4, 5, 8]  # v, w, p, three of R
    for algo in ("kle3", "fourier_ergodic"):
        times = {}
        for v in DIMENSIONS:
            if algo == "fourier_ergodic" and 5**v > MOST:
                break
            box = f"domain.coordinates={order[:v]} domain.low={[-1.0] * v} domain.high={[1.0] * v}"
            more = ["task=quadcopter_se3", f"algo={algo}", "explorer.horizon=5"]
            fourier = algo == "fourier_ergodic"
            more += ["fourier_exploration.samples=100" if fourier else "exploration.memory=0"]
            more += ["explorer.iterations=1"]
            times[v] = _seconds(build(load([*more, *box.replace(", ", ",").split()])), repeats)
            print(f"{NAMES[algo]}, {v} dimensions: timed", flush=True)
        numbers[algo] = {"dimension": list(times), "seconds": list(times.values())}
    return draw(numbers), numbers


def draw(numbers: dict[str, Any]) -> Any:
    """Milliseconds of a plan over the dimension, a line for each controller.

    Of view=cost, also from its JSON; the JSON of other views has no densities.
    """
    figure, ((axes,),) = _subplots(1, 1)
    styles = line_styles(("kle3", "fourier_ergodic"))
    for algo, style in styles.items():
        one = numbers[algo]
        axes.plot(one["dimension"], 1e3 * np.asarray(one["seconds"]), label=NAMES[algo], **style)
    axes.set(xlabel="Dimension of the search space", ylabel="One plan [ms]", yscale="log")
    plain_log(axes.yaxis)
    legend_below(axes)
    return figure


def _seconds(run: Run, repeats: int) -> float:
    """Median wall time [s] of one compiled decision."""
    import jax

    from hybrid_rl.types import Params

    controller, spec, key = run.controllers["full"], run.agent.spec, jax.random.key(0)
    state, obs = controller.init(spec), run.agent.episode.reset(key).obs
    act = jax.jit(lambda state, obs: controller.act(Params(), state, obs, key)[:2])
    times = []
    for _ in range(repeats + 1):
        began = perf_counter()
        jax.block_until_ready(act(state, obs))
        times.append(perf_counter() - began)
    return float(np.median(times[1:]))


def _subplots(down: int, across: int) -> tuple[Any, Any]:
    """A figure, and its panels [down, across]."""
    figure = blank(min(3.4 * across, 9.0), 2.9 * down)
    return figure, figure.subplots(down, across, squeeze=False)


def _show(panel: Any, density: np.ndarray, title: str) -> None:
    """A density on the unit square; all panels have one colour scale."""
    square: Any = {"origin": "lower", "extent": (0, 1, 0, 1), "cmap": "viridis"}
    panel.imshow(density, vmin=0, vmax=BRIGHTEST, **square)
    panel.set(title=title, xlim=(0, 1), ylim=(0, 1), xticks=[0, 1], yticks=[0, 1])
    panel.grid(False)


def _colour_bar(figure: Any, panels: np.ndarray) -> None:
    """The colour scale of all panels."""
    image = panels.flat[0].images[0]
    bar = figure.colorbar(image, ax=list(panels.flat), extend="max", shrink=0.6, aspect=30)
    bar.set_label("Density (mean 1), same scale in all panels")
