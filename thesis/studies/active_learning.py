"""Active learning of a model: cost, held-out loss and information over episodes, figure 4-1.

    python -m hybrid_rl.figures study=active_learning runs="runs/fig_4_1/*" out=fig_4_1.png

Runs of experiment=thesis/fig_4_1; the label of each is the name of its folder. Curves are IQM and
95% band over seeds, after each episode.

    cost          mean of -r over an episode; dotted: of the same planner with the exact model
    held-out loss of the model after the episode, on uniform transitions and along swing-ups of the
                  exact model: mean squared error over the variance of the change
    information   log det and trace of I of the decisions so far under one reference model, which is
                  fitted to uniform transitions: the I of methods' own models is not comparable
    upright       share of seeds with cos th > 0.9 through the last second
    beyond        share of decisions more than a turn of the rod or 2 m away from the start
    refit         held-out loss of a new model, fitted to all decisions of the run

Where the rail has an end, an episode stands for `episode.steps` decisions. The area under a curve
is its mean over episodes: of min(cost, 2) after the first episode, which costs up to 1e9 under
every method; of the logarithm of a loss; `early` of the first three alone. The areas of each seed
are in the JSON. A method differs from another where Mann-Whitney's test of them has p < 0.05,
before any correction.
"""

from typing import Annotated, Any, cast

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from scipy.stats import mannwhitneyu

from hybrid_rl.analysis.results import find
from hybrid_rl.analysis.style import blank, legend_outside, line_styles, plain_log, words
from hybrid_rl.cli.arguments import whole
from hybrid_rl.errors import UsageError
from hybrid_rl.run.saved import restore
from hybrid_rl.settings.build import Run
from hybrid_rl.thesis.studies import unseen
from hybrid_rl.thesis.studies.numbers import banded, rounded
from hybrid_rl.thesis.studies.recorded import Recorded, read
from hybrid_rl.thesis.studies.unseen import Unseen
from hybrid_rl.types import Batch

TASK, EXPERIMENT = "cart_swing_up", "thesis/fig_4_1"
UPRIGHT, SECOND = 0.9, 25  # cos th, decisions of a second
MOST_COST = 2.0  # of an episode in the area under the curve
BEYOND = 2.0  # [m]
UPDATES = 20_000  # Adam steps of the reference model
EARLY = 3  # first episodes, with an area of their own
SIGMA, FLOOR = 0.1, 0.01  # of the reference information
SEED = 123_456  # of held-out data and the reference model
PANELS = {  # quantity -> title
    "cost": "Cost per decision",
    "loss_box": "Held-out loss, uniform",
    "loss_swing_up": "Held-out loss, swing-ups",
    "log_det": "Information, log determinant",
    "trace": "Information, trace",
    "upright": "Share upright in the last second",
}
LOG = ("loss_box", "loss_swing_up", "trace")


def figure(
    runs: Annotated[str, "run folders; a pattern in quotes"],
    against: Annotated[str, "label of the run with which the others are compared"] = "none",
    size: Annotated[int, "uniform held-out transitions", whole(10)] = 4000,
    episodes: Annotated[int, "held-out swing-ups", whole()] = 20,
    refit: Annotated[int, "Adam steps of a new model on all decisions", whole(0)] = 0,
) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers."""
    folders = find(runs)
    if against not in [folder.name for folder in folders]:
        names = ", ".join(folder.name for folder in folders)
        raise UsageError(f"against={against}: no such run; choose one of {names}")
    folders = sorted(folders, key=lambda folder: folder.name != against)  # it is the first line
    data = unseen.collect(EXPERIMENT, size, episodes, SEED)
    first = read(folders[0], TASK).run
    small = next((r for f in folders if _single(r := read(f, TASK).run)), first)
    fit = jax.jit(lambda data, key: unseen.fitted(small, data, UPDATES, key))
    fitted = fit(data.box, jax.random.key(SEED))
    learner: Any = small.agent.learners["model"]
    reference = learner.model, fitted
    recorded = {folder.name: read(folder, TASK) for folder in folders}
    each = {label: measured(one, data, reference) for label, one in recorded.items()}
    _check_size(each)
    numbers = {
        "exact_model": {
            "cost": banded(data.cost),
            "upright": float((data.upright[:, -SECOND:] > UPRIGHT).all(1).mean()),
        },
        "reference_loss": {
            "box": float(unseen.loss(learner.model, fitted, data.box)),
            "swing_up": float(unseen.loss(learner.model, fitted, data.swing_up)),
        },
        "methods": {label: reported(one) for label, one in each.items()},
        "against": against,
    }
    if refit:
        numbers["refit"] = {
            label: refitted(one, data, small, refit) for label, one in recorded.items()
        }
    numbers["differences"] = differences(numbers["methods"], against)
    return draw(numbers), rounded(numbers)


def _single(run: Any) -> bool:
    """Whether the model of a run is not an ensemble."""
    return getattr(run.agent.learners["model"].model, "members", 1) == 1


def measured(recorded: Recorded, data: Unseen, reference: tuple[Any, Any]) -> dict[str, np.ndarray]:
    """The quantities [S, E] of a run after each of E episodes of S learners."""
    made, length = recorded.made, recorded.config.episode.steps
    count = made.reward.shape[1] // length
    by_episode = made.reward[:, : count * length].reshape(-1, count, length)
    theta, x = (made.next_obs[:, : count * length, i].reshape(by_episode.shape) for i in (0, 1))
    learner: Any = recorded.run.agent.learners["model"]
    models = history(recorded, count)

    def loss(data: Batch) -> np.ndarray:
        one = jax.vmap(jax.vmap(lambda params: unseen.loss(learner.model, params, data)))
        return np.asarray(jax.jit(one)(models))

    ends = length * np.arange(1, count + 1)
    all_seeds = (jnp.asarray(x.reshape(-1, x.shape[-1])) for x in (made.obs, made.action))
    F = unseen.derivatives(*reference, SIGMA, *all_seeds)
    rows = [unseen.information(one, ends, FLOOR) for one in np.split(F, len(made.obs))]
    return {
        "cost": -by_episode.astype(float).mean(-1),
        "loss_box": loss(data.box),
        "loss_swing_up": loss(data.swing_up),
        **{name: np.stack([row[name] for row in rows]) for name in rows[0]},
        "beyond": ((np.abs(theta - np.pi) > 2 * np.pi) | (np.abs(x) > BEYOND)).mean(-1),
        "upright": (np.cos(theta[..., -SECOND:]) > UPRIGHT).all(-1).astype(float),
    }


def refitted(recorded: Recorded, data: Unseen, small: Run, updates: int) -> dict[str, Any]:
    """IQM and band of log10 loss of models that are fitted to all decisions of each seed."""
    made, learner = recorded.made, cast(Any, small.agent.learners["model"])

    def one(obs: Array, action: Array, after: Array, key: Array) -> tuple[Array, Array]:
        batch = unseen.transitions(obs, action, after)
        params = unseen.fitted(small, batch, updates, key)
        box, swing_up = (unseen.loss(learner.model, params, each) for each in data[:2])
        return box, swing_up

    keys = jax.random.split(jax.random.key(SEED), len(made.obs))
    losses = jax.jit(jax.vmap(one))(*map(jnp.asarray, (made.obs, made.action, made.next_obs)), keys)
    logs = [np.log10(np.asarray(each)) for each in losses]
    return dict(zip(("loss_box", "loss_swing_up"), map(banded, logs), strict=True))


def history(recorded: Recorded, count: int) -> Any:
    """The models after each of `count` episodes, leaves [S, count, ...].

    Raises:
        UsageError: unless the run has a copy for each episode.
    """
    run, path = recorded.run, recorded.folder.path
    kept: Any = run.agent.learners.get("history")
    if kept is None or kept.every != recorded.config.episode.steps or kept.copies < count:
        raise UsageError(f"runs={path}: needs copies of its models; experiment={EXPERIMENT}")
    learners = restore(path, run)[1].learners
    return jax.tree.map(
        lambda copies, last: jnp.concatenate([copies[:, 1:count], last[:, None]], axis=1),
        learners["history"].models,
        learners["model"].model,
    )


def _check_size(each: dict[str, dict[str, np.ndarray]]) -> None:
    shapes = {label: one["cost"].shape for label, one in each.items()}
    if len(set(shapes.values())) > 1:
        raise UsageError(f"runs: need the same seeds and episodes, have {shapes}")


def reported(one: dict[str, np.ndarray]) -> dict[str, Any]:
    """IQM and band [3, E] of each quantity, the share upright [E]; IQM and band [3] of areas.

    And the areas of each seed [S].
    """
    areas = area(one)
    return {
        "seeds": len(one["cost"]),
        **{name: banded(each) for name, each in one.items() if name != "upright"},
        "upright": one["upright"].mean(0),
        "first_cost": one["cost"][:, 0],
        "area": {name: banded(values) for name, values in areas.items()},
        "each": areas,
    }


def area(one: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The area under each curve, and the cost of the last three episodes: name -> [S]."""
    cost = np.minimum(one["cost"], MOST_COST)
    logs = {name: np.log10(one[name]) for name in LOG}
    rest = {name: one[name] for name in ("log_det", "log_det_diagonal", "upright", "beyond")}
    each = {"cost": cost[:, 1:], "last_cost": cost[:, -3:], **logs, **rest}
    names = ("loss_box", "loss_swing_up", "log_det")
    early = {f"{name}_early": each[name][:, :EARLY] for name in names}
    return {name: values.mean(1) for name, values in {**each, **early}.items()}


def differences(methods: dict[str, Any], against: str) -> dict[str, Any]:
    """For each method and area: higher or lower than that of `against`, or no difference."""
    base = methods[against]["each"]

    def verdict(one: Any, other: Any) -> str:
        test, pairs = mannwhitneyu(one, other), len(one) * len(other)
        if test.pvalue >= 0.05:
            return "no difference"
        return "higher" if test.statistic > pairs / 2 else "lower"

    return {
        label: {name: verdict(values, base[name]) for name, values in one["each"].items()}
        for label, one in methods.items()
        if label != against
    }


def summary(numbers: dict[str, Any]) -> list[str]:
    """The exact model, then a line of areas for each method."""
    exact = numbers["exact_model"]
    lines = [f"exact model: cost {_text(exact['cost'])}, upright {exact['upright']:.0%}"]
    for label, one in numbers["methods"].items():
        areas = one["area"]
        apart = [
            f"{k} {v}" for k, v in numbers["differences"].get(label, {}).items() if v[0] != "n"
        ]
        words = f"; against {numbers['against']}: {', '.join(apart)}" if apart else ""
        lines.append(
            f"{label}, {one['seeds']} seeds: cost {_text(areas['cost'])}, last three episodes "
            f"{_text(areas['last_cost'])}, log10 loss: uniform {_text(areas['loss_box'])}, "
            f"swing-ups {_text(areas['loss_swing_up'])}, log det {_text(areas['log_det'])}, "
            f"upright {_text(areas['upright'])}{words}"
        )
    for label, one in numbers.get("refit", {}).items():
        box, swing_up = (_text(one[name]) for name in ("loss_box", "loss_swing_up"))
        lines.append(f"{label}, fitted again: log10 loss: uniform {box}, swing-ups {swing_up}")
    return lines


def _text(values: Any) -> str:
    middle, low, high = values
    return f"{middle:.4g} [{low:.4g}, {high:.4g}]"


def draw(numbers: dict[str, Any]) -> Any:
    """A panel for each quantity; information is that of one reference model."""
    methods, exact = numbers["methods"], numbers["exact_model"]
    styles = line_styles(methods)
    figure = blank(9, 5.6)
    panels = np.ravel(figure.subplots(2, 3))
    for axes, (name, title) in zip(panels, PANELS.items(), strict=True):
        for label, one in methods.items():
            _curve(axes, words(label), np.asarray(one[name]), styles[label])
        axes.set(title=title, xlabel="Episodes")
        if name in LOG:
            axes.set_yscale("log")
            plain_log(axes.yaxis)
    panels[0].axhline(exact["cost"][0], color="k", lw=0.8, ls=":", label="exact model")
    panels[0].set_ylim(-0.5, MOST_COST)
    panels[-1].set_ylim(-0.02, 1.02)
    panels[-1].axhline(exact["upright"], color="k", lw=0.8, ls=":")
    legend_outside(panels[0])
    return figure


def _curve(axes: Any, label: str, values: np.ndarray, style: dict[str, Any]) -> None:
    """IQM and band [3, E], or the share of a yes or no [E]."""
    middle, *ends = np.atleast_2d(values)
    episodes = np.arange(1, len(middle) + 1)
    axes.plot(episodes, middle, label=label, lw=1.2, **style | {"marker": None})
    if ends:
        axes.fill_between(episodes, *ends, color=style["color"], alpha=0.1, lw=0)
