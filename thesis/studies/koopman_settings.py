"""Settings of Koopman learning: how many falling quadcopters stop, over horizon, forgetting, prior.

    python -m hybrid_rl.figures study=koopman_settings trials=250 out=koopman_settings.png

A trial is one fall of figure 7-2. It succeeds if |v|^2 + |w|^2 stays below 0.01 from some time to
its end. For each horizon of the regulator all trials of all values of forgetting and prior run side
by side in one program: 10,000 with 40 pairs of values and 250 trials. The numbers have the share of
successes, the median time of those, and the trials per second without compilation.
"""

import copy
from collections.abc import Sequence
from time import perf_counter
from typing import Annotated, Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.analysis.style import blank
from hybrid_rl.cli.arguments import numbers as numbers_kind
from hybrid_rl.cli.arguments import whole
from hybrid_rl.settings.build import Run, build, load

FALL = "experiment=thesis/fig_7_2"
HORIZONS = (16, 32, 64, 128, 256)
FORGETTING = (0.9, 0.95, 0.97, 0.98, 0.985, 0.99, 0.995, 1.0)
PRIORS = (1e-4, 1e-3, 1e-2, 0.1, 1.0)
MOST_ACROSS = 3  # panels
BELOW = 0.01  # of |v|^2 + |w|^2


def figure(
    method: Annotated[str, "of the experiment thesis/fig_7_2"] = "koopman_active",
    horizons: Annotated[Sequence, "of the regulator [decisions]", numbers_kind(whole())] = HORIZONS,
    forgetting: Annotated[Sequence, "factors per decision", numbers_kind()] = FORGETTING,
    priors: Annotated[Sequence, "weights of the prior", numbers_kind()] = PRIORS,
    trials: Annotated[int, "of each setting", whole()] = 20,
    seed: Annotated[int, "of the first trial", whole(0)] = 1000,
) -> tuple[Any, dict[str, Any]]:
    """A panel of successes for each horizon."""
    results = []
    for horizon in map(int, horizons):
        fixed = (f"policy_learner.horizon={horizon}", "replay.capacity=1", f"seed={seed}")
        run = build(load([FALL, f"algo={method}", *fixed]))
        results.append(falls(run, np.array(forgetting), np.array(priors), trials))
        share = results[-1]["share"]
        print(f"horizon {horizon}: best {share.max():.0%}", flush=True)
    axes = {"horizons": horizons, "forgetting": forgetting, "priors": priors}
    numbers = {
        "method": method,
        "device": jax.devices()[0].device_kind,
        "trials": trials,
        "seed": seed,
        **{name: list(values) for name, values in axes.items()},
        **{name: [one[name] for one in results] for name in results[0]},
    }
    return draw(numbers), numbers


def summary(numbers: dict[str, Any]) -> list[str]:
    """The best settings of each horizon, and the speed."""
    lines = []
    for horizon, share, speed in zip(
        numbers["horizons"], numbers["share"], numbers["trials_per_s"], strict=True
    ):
        f, p = np.unravel_index(np.argmax(share), np.shape(share))
        best = f"forgetting {numbers['forgetting'][f]:g}, prior {numbers['priors'][p]:g}"
        lines.append(
            f"horizon {horizon:g}: at best {np.max(share):.1%} stop, with {best}; "
            f"{speed:,.0f} trials/s"
        )
    return lines


def falls(run: Run, forgetting: np.ndarray, priors: np.ndarray, trials: int) -> dict[str, Any]:
    """Share of successes and median time [s] [F, P] of `trials` falls of each setting."""
    agent, steps = run.agent, run.agent.episode.steps

    def one(forgetting: Array, prior: Array, key: Array) -> Array:
        """The last decision [] of a fall at which it is not below the threshold; 0: none."""
        learner = with_fields(agent.learners["model"], forgetting=forgetting, prior=prior)
        own = with_fields(agent, learners={**agent.learners, "model": learner})

        def decide(carry: tuple, step: Array) -> tuple:
            state, last = carry
            state, metrics = own.step(state, step)
            above = ~(metrics["world/twist"] < BELOW)
            return (state, jnp.where(above, step + 1, last)), None

        first = own.init(key), jnp.zeros((), jnp.int32)
        return jax.lax.scan(decide, first, jnp.arange(steps))[0][1]

    settings = np.meshgrid(forgetting, priors, np.arange(trials), indexing="ij")
    keys = jax.vmap(jax.random.key)(run.config.seed + jnp.asarray(settings[2].ravel()))
    each = [jnp.asarray(value.ravel(), jnp.float32) for value in settings[:2]]
    program = jax.jit(jax.vmap(one)).lower(*each, keys).compile()
    began = perf_counter()
    last = np.asarray(program(*each, keys)).reshape(settings[0].shape)
    taken, stays = perf_counter() - began, last < steps
    with np.errstate(all="ignore"):
        times = np.where(stays, (last + 1) * agent.spec.dt, np.nan)
    return {
        "share": stays.mean(-1),
        "time": _median(times),
        "trials_per_s": last.size / taken,
        "seconds": taken,
    }


def with_fields(part: Any, **values: Any) -> Any:
    """A copy of a part with other fields that are not checked: they may be traced."""
    other = copy.copy(part)
    for name, value in values.items():
        object.__setattr__(other, name, value)
    return other


def _median(times: np.ndarray) -> np.ndarray:
    """Median over the last axis without NaN; NaN where all are."""
    flat = times.reshape(-1, times.shape[-1])
    each = [np.median(row[~np.isnan(row)]) if (~np.isnan(row)).any() else np.nan for row in flat]
    return np.array(each).reshape(times.shape[:-1])


def draw(numbers: dict[str, Any]) -> Any:
    """Share of successes by forgetting and prior, a panel for each horizon."""
    horizons, forgetting, priors = (numbers[name] for name in ("horizons", "forgetting", "priors"))
    across = min(len(horizons), MOST_ACROSS)
    down = -(-len(horizons) // across)
    size = (1.0 + 2.6 * across, down * (0.8 + 0.26 * len(forgetting)))
    figure = blank(*size)
    axes: Any = figure.subplots(down, across, squeeze=False, sharey=True)
    for panel in axes.flat[len(horizons) :]:
        panel.remove()
    panels = axes.flat[: len(horizons)]
    for panel, horizon, share in zip(panels, horizons, numbers["share"], strict=True):
        panel.grid(False)
        image = panel.imshow(share, vmin=0, vmax=1, cmap="viridis", aspect="auto")
        panel.set(title=f"horizon of {horizon:g} decisions", xlabel="weight of the prior")
        panel.set_xticks(range(len(priors)), [f"{value:g}" for value in priors])
        panel.set_yticks(range(len(forgetting)), [f"{value:g}" for value in forgetting])
        for (i, j), value in np.ndenumerate(np.asarray(share)):
            colour = "black" if value > 0.6 else "white"
            panel.text(j, i, f"{value:.0%}", ha="center", va="center", color=colour, size=7)
    for panel in axes[:, 0]:
        panel.set(ylabel="forgetting per decision")
    figure.colorbar(image, ax=list(panels), label="share of falls that stop")
    return figure
