"""Where a method spends its time, beside the target that it explores in proportion to.

    python -m hybrid_rl.studies.ergodic_coverage view=control out=fig_6_1.png      KL against Fourier's control
    python -m hybrid_rl.studies.ergodic_coverage view=average out=fig_6_2.png      four ways to see one path
    python -m hybrid_rl.studies.ergodic_coverage view=marginals out=marginals.png  any dimension, also: task=
    python -m hybrid_rl.studies.ergodic_coverage view=cost out=cost.png            of a plan, by dimension

The numbers drawn are written beside the picture, as JSON; what they come to is printed as it is
found, over several seeds as interquartile mean and 95% band.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, one_of, output, read, whole
from hybrid_rl.config import Run, build, load
from hybrid_rl.studies.curves import spread
from hybrid_rl.studies.density_plots import colour_bar, show, subplots
from hybrid_rl.studies.style import legend_below, plain_log

VIEWS = ("control", "average", "marginals", "cost")
SUFFIXES = (".png", ".pdf", ".svg")
ARGUMENTS = (
    Argument("view", "control", ", ".join(VIEWS), one_of(*VIEWS)),
    Argument("out", "ergodicity.png", f"the picture: {', '.join(SUFFIXES)}; numbers beside it"),
    Argument("task", "quadcopter_se3", "of view=marginals"),
    Argument("seeds", 10, "paths that are compared", whole()),
    Argument("steps", 400, "decisions of each path", whole()),
)
FIGURE = ("experiment=thesis/fig_6_1",)
NAMES = {"kle3": "KL-ergodic", "fourier_ergodic": "Fourier", "kle3_jensen": "Jensen's bound"}
GRID = 100  # cells a side
VARIANCE = 0.005  # [m^2] of the average whose divergence is measured
REACH = (2, 4, 5, 6, 9, 12)  # dimensions whose cost is measured
NAMES_OF = {  # task -> its search coordinates
    "quadcopter_se3": [*(f"v_{i} [m/s]" for i in "xyz"), *(f"w_{i} [rad/s]" for i in "xyz")],
    "point_mass": ["x", "y"],
    "cart_double_pendulum": ["position on the rail [m]"],
    "no_dynamics": ["position on the rail [m]"],
}
MOST = 5**6  # Fourier coefficients beyond which no memory is left


def paths(run: Run, seeds: int, steps: int) -> np.ndarray:
    """Search states [seeds, steps+1, v] of the run's controller, without learning."""
    import jax

    from hybrid_rl.training.rollout import rollout
    from hybrid_rl.types import Params

    at, controller = tuple(run.config.search.coordinates), run.controllers["full"]
    one = lambda key: rollout(run.agent.episode, controller, Params(), key, steps).obs  # noqa: E731
    found = jax.jit(jax.vmap(one))(jax.random.split(jax.random.key(run.config.seed), seeds))
    return np.asarray(found)[:, :, at]


def divergences(run: Run, x: np.ndarray, count: int = 2000) -> np.ndarray:
    """D(p || q) [T] [nat] after each step of x [T+1, v], at points drawn once; q has VARIANCE."""
    import jax
    import jax.numpy as jnp

    from hybrid_rl.core import ergodic

    low, high = tuple(run.config.search.low), tuple(run.config.search.high)
    s = ergodic.uniform(low, high, count, jax.random.key(0))
    log_p = jax.nn.log_softmax(_log_density(run, s))
    sides = jnp.array(high) - jnp.array(low)
    apart = (s[:, None] - jnp.asarray(x)[None]) ** 2 / (VARIANCE * sides**2)[None, None]
    log_each = -0.5 * jnp.sum(apart, -1) - 0.5 * jnp.sum(jnp.log(2 * jnp.pi * VARIANCE * sides**2))
    log_sum = jax.lax.cumlogsumexp(log_each, axis=1)
    log_q = jnp.logaddexp(log_sum - jnp.log(jnp.arange(1, len(x) + 1))[None], jnp.log(1e-6))
    relative = log_p + jnp.log(count / jnp.prod(sides))
    return np.asarray(jnp.exp(log_p) @ (relative[:, None] - log_q))[1:]


def _log_density(run: Run, s: Any) -> Any:
    """log p [N] of the run's target."""
    import jax
    from hydra.utils import instantiate

    from hybrid_rl.types import Params

    target = instantiate(run.config.target, _convert_="all")
    return jax.vmap(target.log_density, (None, 0))(Params(), s)


def _grid() -> np.ndarray:
    """Points [GRID^2, 2] of the unit square."""
    side = (np.arange(GRID) + 0.5) / GRID
    return np.stack(np.meshgrid(side, side, indexing="xy"), -1).reshape(-1, 2)


def _picture(density: Any) -> np.ndarray:
    """[GRID, GRID] of mean one."""
    density = np.asarray(density).reshape(GRID, GRID)
    return density / np.abs(density).mean()


def averages(x: np.ndarray) -> dict[str, np.ndarray]:
    """Pictures of the time average of x [M, 2]."""
    import jax.numpy as jnp

    from hybrid_rl.core import ergodic, fourier

    s, at, unit = jnp.asarray(_grid()), jnp.asarray(x), ((0.0, 0.0), (1.0, 1.0))
    raw = np.histogram2d(x[:, 1], x[:, 0], bins=25, range=[[0, 1], [0, 1]])[0]
    c = fourier.features(at, *unit, 20).mean(0)
    mean_apart = jnp.mean(jnp.sum((s[:, None] - at[None]) ** 2, -1), 1)
    return {
        "raw: cells visited": np.kron(raw, np.ones((4, 4))) / raw.mean(),
        "Fourier, 20 cosines a side": _picture(fourier.features(s, *unit, 20) @ c),
        "sum of Gaussians (6.1)": _picture(jnp.exp(ergodic.log_sum(s, at, jnp.full(2, VARIANCE)))),
        "Jensen's bound (6.17)": _picture(jnp.exp(-0.5 * mean_apart / VARIANCE)),
    }


def control(seeds: int, steps: int) -> tuple[Any, dict]:
    """Paths and averages of both controllers, and their divergences over time."""
    figure, panels = subplots(2, 3)
    numbers: dict[str, Any] = {"variance": VARIANCE, "seeds": seeds}
    for panel in panels[:, 2]:
        panel.remove()
    over_time = figure.add_subplot(panels[0, 0].get_gridspec()[:, 2])
    for i, algo in enumerate(("kle3", "fourier_ergodic", "kle3_jensen")):
        run = build(load([*FIGURE, f"algo={algo}", f"episode.steps={steps + 1}"]))
        x = paths(run, seeds, steps)
        each = np.array([divergences(run, one) for one in x])
        dt, name = run.agent.spec.dt, NAMES[algo]
        print(f"{name}: D(p || q) {spread(each[:, -1])} nat after {steps * dt:g} s", flush=True)
        t = dt * np.arange(1, steps + 1)
        numbers[algo] = {"t": t[9::10], "divergence": each[:, 9::10]}
        low, middle, high = np.quantile(each, [0.25, 0.5, 0.75], axis=0)
        over_time.semilogy(t, middle, label=name)
        over_time.fill_between(t, low, high, alpha=0.2, lw=0)
        if i < 2:
            density = _picture(np.exp(_log_density(run, _grid())))
            show(panels[i][0], density, f"target, path: {name}")
            panels[i][0].plot(*x[0].T, color="#D55E00", lw=0.7)
            show(panels[i][1], averages(x[0])["sum of Gaussians (6.1)"], "its time average")
    over_time.set(xlabel="Time [s]", title=f"D(p || q) [nat], {seeds} seeds")
    plain_log(over_time.yaxis)
    legend_below(over_time)
    colour_bar(figure, panels[:, :2])
    return figure, numbers


def average(seeds: int, steps: int) -> tuple[Any, dict]:
    """One path of KL-ergodic control, and four ways to see its time average."""
    run = build(load([*FIGURE, f"episode.steps={steps + 1}"]))
    x = paths(run, 1, steps)[0]
    target = _picture(np.exp(_log_density(run, _grid())))
    pictures = averages(x)
    figure, panels = subplots(2, 3)
    path, *others = panels.flat
    show(path, np.full((GRID, GRID), np.nan), "path")
    path.plot(*x.T, color="#D55E00", lw=0.8)
    for panel, (title, picture) in zip(others, {"target": target, **pictures}.items(), strict=True):
        show(panel, picture, title)
    colour_bar(figure, panels)
    away = {name: float(np.abs(each - target).mean() / 2) for name, each in pictures.items()}
    negative = {name: float(-each[each < 0].sum() / each.size) for name, each in pictures.items()}
    for name in pictures:
        line = f"{name}: total variation to the target {away[name]:.3g}"
        print(f"{line}, negative mass {abs(negative[name]):.3g}", flush=True)
    return figure, {"total_variation_to_target": away, "negative_mass": negative, "x": x}


def marginals(task: str, seeds: int, steps: int) -> tuple[Any, dict]:
    """Per coordinate of the search space: the target's marginal and the time's, any dimension."""
    import jax

    from hybrid_rl.core import ergodic

    run = build(load([f"task={task}", "algo=kle3", f"episode.steps={steps + 1}"]))
    low, high = tuple(run.config.search.low), tuple(run.config.search.high)
    s = np.asarray(ergodic.uniform(low, high, 100_000, jax.random.key(0)))
    p = np.asarray(jax.nn.softmax(_log_density(run, s)))
    x = paths(run, seeds, steps)
    print(f"{task}: {seeds} seeds of {steps} decisions", flush=True)
    figure, panels = subplots(-(-len(low) // 3), min(3, len(low)))
    names = [f"observation {number}" for number in run.config.search.coordinates]
    names = NAMES_OF.get(task, names)
    shares = {"target": [], "time": []}
    for j, (panel, name) in enumerate(zip(panels.flat, names, strict=False)):
        edges = np.linspace(low[j], high[j], 31)
        target = _share(s[:, j], edges, p)
        each = np.array([_share(one[:, j], edges) for one in x])
        time = _share(x[:, :, j].ravel(), edges)
        for share, label in ((target, "target"), (time, "time average of the paths")):
            panel.stairs(share, edges, label=label, lw=1.4)
        panel.set(xlabel=name, ylabel="Density")
        shares["target"].append(target)
        shares["time"].append(time)
        away = 0.5 * np.abs(each - target).sum(1) * (edges[1] - edges[0])
        print(f"{name}: total variation of target and time average {spread(away)}", flush=True)
    for panel in list(panels.flat)[len(low) :]:
        panel.remove()
    legend_below(panels[-1][0])
    figure.suptitle(f"{task}: marginals of {seeds} seeds, {steps} decisions")
    return figure, {"task": task, "low": low, "high": high, **shares}


def _share(values: np.ndarray, edges: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
    """Density [B] of values [N] in bins, of those that lie in one."""
    share = np.histogram(values, edges, weights=weights)[0]
    return share / max(share.sum() * (edges[1] - edges[0]), 1e-12)


def cost(repeats: int = 9) -> tuple[Any, dict]:
    """Seconds of one plan of the quadcopter, by the dimension that is searched."""
    figure, panels = subplots(1, 1)
    numbers: dict[str, Any] = {"horizon": 5, "samples": 100, "modes": 5, "repeats": repeats}
    order = [12, 13, 14, 15, 16, 17, 0, 1, 2, 4, 5, 8]  # v, w, p, three of R
    for algo in ("kle3", "fourier_ergodic"):
        times = {}
        for v in REACH:
            if algo == "fourier_ergodic" and 5**v > MOST:
                break
            box = f"search.coordinates={order[:v]} search.low={[-1.0] * v} search.high={[1.0] * v}"
            more = ["task=quadcopter_se3", f"algo={algo}", "explorer.horizon=5"]
            more += ["fourier_exploration.samples=100"] if algo == "fourier_ergodic" else []
            times[v] = _seconds(build(load([*more, *box.replace(", ", ",").split()])), repeats)
            line = f"{NAMES[algo]}, {v} dimensions: {1e3 * times[v]:.3g} ms a plan"
            print(f"{line} (median of {repeats})", flush=True)
        numbers[algo] = {"dimension": list(times), "seconds": list(times.values())}
        milliseconds = 1e3 * np.array(list(times.values()))
        panels[0][0].semilogy(list(times), milliseconds, "o-", label=NAMES[algo])
    panels[0][0].set(xlabel="Dimension of the search space", ylabel="One plan [ms]")
    plain_log(panels[0][0].yaxis)
    legend_below(panels[0][0])
    return figure, numbers


def _seconds(run: Run, repeats: int) -> float:
    """Median wall time of one decision, compiled."""
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


def _plain(value: Any) -> Any:
    """What JSON holds; float32, four digits."""
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, Sequence | np.ndarray) and not isinstance(value, str):
        return [_plain(each) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float | np.floating) else value


def save(figure: Any, numbers: dict, out: Path) -> None:
    """The picture, and its numbers beside it."""
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=150)
    out.with_suffix(".json").write_text(json.dumps(_plain(numbers)) + "\n", encoding="utf-8")


def main() -> None:
    """The command."""
    said, _ = read(__doc__, ARGUMENTS)
    seeds, steps = said["seeds"], said["steps"]
    out = output("out", said["out"], SUFFIXES, ".json")
    command.prepare(load(FIGURE))
    views: dict[str, Callable[[], tuple[Any, dict]]] = {
        "control": lambda: control(seeds, steps),
        "average": lambda: average(seeds, steps),
        "marginals": lambda: marginals(said["task"], seeds, steps),
        "cost": cost,
    }
    save(*views[said["view"]](), out)
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
