"""Figures 7-6 and 7-7 in docs/results/chapter7.md."""

from typing import Any

from pages.cited import Table, Text
from pages.values import read

BALL = {  # label of the page -> label of the JSON
    "active, gain": "gain",
    "active, norm (7.10)": "norm",
    "noise of equal power": "noise",
    "none": "none",
    "active, gain, linear z [5]": "gain_linear",
    "none, linear z [5]": "none_linear",
    "active, gain, the printed weights (1 for each product)": "gain_printed_weights",
    "active, gain, 30 random decisions": "gain_short_warm_up",
    "exact sensors: active, gain": "koopman_track decisions=[100, 500]",
    "exact sensors: none": "koopman_track decisions=[100, 0]",
}
SAWYER = {
    "z 51, active (gain), K updated": "gain",
    "z 51, noise (0.0050; active 0.0043 rms), K updated": "noise",
    "z 51, none, K updated": "none",
    "z 15, active, K updated": "z15_gain",
    "z 51, active, K frozen": "gain_frozen",
    "z 51, noise, K frozen": "noise_frozen",
    "z 51, none, K frozen": "none_frozen",
    "z 15, active, K frozen": "z15_gain_frozen",
    "rates with noise of 0.001 rad/s: active, K updated": "gain_sensor_noise",
    "rates with noise of 0.001 rad/s: none, K updated": "none_sensor_noise",
    "z 51, active, K updated, without feed-forward": "no_feedforward",
    "z 51, active, K updated, weights of the thesis": "thesis_weights",
    "computed torque (20 rad/s), known model": "computed_torque",
    "joint PD": "joint_pd",
}
PAYLOAD = {
    "z 15, none, K updated, 0.3 s of random torques": "z15_payload",
    "computed torque, model without the payload": "computed_torque",
    "joint PD": "joint_pd",
    "z 51, active, K updated, 1 s of random torques": "gain_payload",
}


def methods(*files: str) -> dict[str, Any]:
    """The methods of JSON files together."""
    merged: dict[str, Any] = {}
    for file in files:
        merged |= read(f"fig_7_{file}")["methods"]
    return merged


BALLS = methods("6", "6_rows", "6_exact_sensors")
LONG, SHORT = methods("7_rows", "7"), methods("7_settings", "7_two_seconds")
HEAVY = methods("7_payload")


def ball(label: str, column: str) -> list[float]:
    """A cell of the table of figure 7-6."""
    frozen = column.startswith(("K frozen", "frozen"))
    one = BALLS.get(BALL[label] + ("_frozen" if frozen else ""))
    if one is None:
        return []
    what = column.split(": ")[-1]
    values = {
        "RMSE [mm]": one["rmse_mm"],
        "Pearson x, y": pearson(one),
        "lag [ms]": one["lag_ms"],
        "lost": [one["lost"]],
    }
    return values[what]


def sawyer(label: str, column: str) -> list[float]:
    """A cell of the table of figure 7-7."""
    name = SAWYER[label]
    if column.startswith("greatest"):
        return (LONG | SHORT if name not in LONG else LONG)[name]["greatest_rate"]
    one = (SHORT if "2 s" in column else LONG).get(name)
    if one is None:
        return []
    return one["rmse_mm"] if column.startswith("learning") else one["lag_ms"]


def payload(label: str, column: str) -> list[float]:
    """A cell of the table with a payload."""
    one = HEAVY[PAYLOAD[label]]
    if column == "RMSE [mm]":
        return one["rmse_mm"]
    if column.startswith("greatest of"):
        return [max(one["rmse_mm_of_trials"])]
    return one["greatest_rate"]


def rmse(known: dict[str, Any], *names: str) -> list[float]:
    """RMSE [mm] of methods."""
    return [known[name]["rmse_mm"][0] for name in names]


def pearson(one: dict[str, Any]) -> list[float]:
    """Correlations of the two coordinates."""
    return [axis[0] for axis in one["correlation"] if axis]


CITED = [
    Table(
        "exploration | K updated: RMSE [mm] | Pearson x, y | lag [ms] | lost | "
        "K frozen: RMSE [mm] | frozen: Pearson x, y | frozen: lag [ms] | frozen: lost",
        ball,
    ),
    Table(
        " | learning 20 s | its lag [ms] | learning 2 s | lag after 2 s [ms] | "
        "greatest joint rate while learning [rad/s]",
        sawyer,
    ),
    Table(" | RMSE [mm] | greatest of 20 | greatest joint rate while learning [rad/s]", payload),
    Text(
        "are worse than none, # against # mm",
        rmse(BALLS, "koopman_track decisions=[100, 500]", "koopman_track decisions=[100, 0]"),
    ),
    Text("more than the exploration: # against # mm", rmse(BALLS, "gain", "gain_frozen")),
    Text("on the known model, # mm, after 2 s", rmse(SHORT, "none")),
    Text("with K updated it does harm, # against # mm", rmse(LONG, "gain", "none")),
    Text(
        "it may help, # against # mm, as noise does (#)",
        rmse(LONG, "gain_frozen", "none_frozen", "noise_frozen"),
    ),
    Text("while K is updated (# against #)", rmse(LONG, "gain", "z15_gain")),
    Text("it is frozen (# against #)", rmse(LONG, "gain_frozen", "z15_gain_frozen")),
    Text("by a factor of #,", [rmse(HEAVY, "computed_torque")[0] / rmse(HEAVY, "z15_payload")[0]]),
    Text(
        "all rows but joint PD (#, #) and the weights of the thesis (#, #)",
        [*pearson(LONG["joint_pd"]), *pearson(SHORT["thesis_weights"])],
    ),
    Text(
        "on the path is # of the limits in all rows, # for joint PD",
        [LONG[name]["rms_action"][0] for name in ("gain", "joint_pd")],
    ),
    Text(
        "with commands of # root mean square, while # are enough",
        [BALLS[name]["rms_action"][0] for name in ("gain", "koopman_track decisions=[100, 0]")],
    ),
    Text("without it # mm", rmse(SHORT, "no_feedforward")),
]
PLAIN = [  # settings, and numbers of runs on other seeds and of the prototype, which have no file
    "1,676 falls of 4 s a second",
    "in sand at 30 Hz: 100 random",
    "random decisions (3.3 s), learning until",
    "s), learning until 20 s, then the",
    "thesis' path for 20 s. The world",
    "with the thesis. 20 trials, seeds 0",
    "seeds 0 to 19; 30 to",
    "19; 30 to 90 s a row.",
    "camera's noise (3 mm); IQM [95%",
    "end; frozen: until 20 s (`model_learner.until=600`). Lag:",
    "equal power (0.206 of full command,",
    "thesis' weight of 80 has no meaning",
    "are larger (0.36 against 0.21),",
    "help: z with 5 entries is as",
    "deviation is sqrt(2) 3 mm",
    "sqrt(2) 3 mm 30 Hz = 0.13",
    "help: R = 1 instead of 0.1",
    "of 0.1 gave 67 mm, R =",
    "mm, R = 10 187 mm (seeds",
    "187 mm (seeds 1000 to 1019, prior",
    "to 1019, prior 0.01). * Lost",
    "speed, up to 30 m. Then neither",
    "decisions. Out of 100 trials (seeds 1000",
    "(seeds 1000 to 1099) were lost:",
    "1099) were lost: 3 with 30 random",
    "decisions and prior 0.01, 2",
    "with prior 1, 4 with",
    "velocity scaled by 0.5, 7 with",
    "with linear z, 9 with a horizon",
    "32 instead of 16, **0 with",
    "16, **0 with 100 random decisions** (and",
    "random decisions** (and 0 with",
    "with 30 of full amplitude",
    "on seeds from 1000 on. Runs of",
    "Runs of seeds 0 to 19 with",
    "earlier settings (30 random decisions, prior",
    "random decisions, prior 0.01) had shown",
    "too (gain 0, none 1,",
    "none 1, norm 3 of 20); that",
    "seven joints at 100 Hz, no damping",
    "compensated; starts within 0.05 rad of the",
    "random torques (1% of the",
    "limits), learning until 20 s or 2",
    "z has the 51 printed functions, with",
    "the rates times 0.2; 15 are",
    "and a constant. 20 trials, seeds 0",
    "seeds 0 to 19, 25 to",
    "19, 25 to 190 s a row,",
    "[mm], IQM [95% band]; Pearson's",
    "z rounds to 1.0000 in all rows",
    "0.10 mm, after 2 s of learning.",
    "with gains of 30 rad/s it has",
    "rad/s it has 0.08 mm (4 seeds),",
    "float64, seeds from 1000 on). * **The",
    "The thesis has 200 for angles and",
    "one second, and 15 mm are left.",
    "are left. With 200 for angles and",
    "for angles and 0.8 for",
    "for rates (20 in the scaled",
    "the scaled coordinates; 16 rad/s) it is",
    "rad/s) it is 0.10 mm. Feed-forward is",
    "prototype (seeds from 1000 on): the regulator",
    "every fifth (0.045 against 0.045 mm,",
    "the rates). Forgetting 0.99 gave 0.095 instead",
    "0.095 instead of 0.12 mm with 15",
    "two trials with 51. * **Not",
    "joints drift by 0.3 rad (median of",
    "the largest, seeds 1000 to 1019) in",
    "returns them at 6 rad/s. With",
    "weights it is 0.6 rad/s. * With",
    "rad/s. * With 51 functions the scale",
    "safety. Rates of 5 rad/s have sixth",
    "sixth powers of 15,000. With rates",
    "settings tried; times 0.3, 3 of",
    "0.3, 3 of 20 (weight 0.45 of",
    "unscaled rates); times 0.2, 0 of",
    "0.2, 0 of 20 (0.4) and 0",
    "and 0 of 40 (0.8). The margin",
    "random torques and 0.8 it was 3",
    "was 3 of 20 (all in the",
    "prototype, seeds from 1000 on). In float32,",
    "float32, with scale 0.3 and 0.45, one",
    "0.45, one of 4 was",
    "with corrections of 0.01 instead of 0.003,",
    "and one of 20 had 1.2 mm",
    "mm (seeds from 1000 on). Payload",
    "Payload of 1 kg in the",
    "to all (`env.payload=1.0`), 2 s of learning:",
    "that, or with 51 functions from 0.3",
    "from 0.3 to 0.6 s of data",
    "[Rows of 20 s](fig_7_7_rows.json), [2 s](fig_7_7_two_seconds.json),",
    "Not run: forgetting 0.999, the norm",
    "maker's damping and 5 s of learning",
    "Sawyer; noise with 2 s of learning.",
    "them on seeds 1000 to 1019.",
]
