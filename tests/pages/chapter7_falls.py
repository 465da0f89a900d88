"""Figures 7-2 and 7-3 in docs/results/chapter7.md."""

from typing import Any

from pages.cited import Table, Text
from pages.values import read

ROWS = {  # label of the page, up to a comma -> label of the JSON
    "koopman_babble for 1 s": "koopman_babble",
    "koopman_noise of equal power": "koopman_noise",
    "the thesis' numbers": "thesis",
    "the author's code": "author",
}
METHODS = {"active": "koopman_active", "noise": "koopman_noise", "direct": "koopman_direct"}
CONDITIONS = {
    "as above": "turn_0",
    "no random decisions at the start": "nostart",
    "learning ends after 0.25 s": "short",
    "learning ends after 1 s": "learn1s",
    "no drag": "nodrag",
    "sensor noise 0.002": "sensor",
    "sensor noise 0.002, forgetting 0.98, prior 0.01, T = 128": "sensor_first_settings",
    "random attitude, 1 rad": "turn",
    "z without products": "linear",
}
BEYOND = {  # label of the page -> JSON, label there
    "bilinear, (u, z_i u) with z of 9 numbers": ("beyond", "bilinear_linear"),
    "bilinear, with products in z too": ("beyond", "bilinear"),
    "regulator of a draw of K (Thompson), noise 0.001": ("beyond", "koopman_direct thompson=0.001"),
    "rotor 1 loses 30% of its thrust at 2 s: active": ("rotor_03", "koopman_active"),
    "the same: direct": ("rotor_03", "koopman_direct"),
    "the same: known K, no learning": ("rotor_03", "koopman_known"),
    "rotor 1 loses 50% at 2 s: active": ("rotor_05", "koopman_active"),
    "50%, known K, no learning": ("rotor_05", "koopman_known"),
}
SPEED = read("koopman_speed")["decisions_per_s"]
SETTINGS = read("koopman_settings")


def methods(name: str) -> dict[str, Any]:
    """The methods of a JSON file."""
    return read(f"fig_7_{name}")["methods"]


def percent(one: dict[str, Any], time: str = "4") -> list[float]:
    """Share [%] at rest and its interval."""
    return [100 * value for value in one["at_rest"][time]]


def main(label: str, column: str) -> list[float]:
    """A cell of the table of figure 7-2."""
    plain = label.split(",")[0]
    one = methods("2")[ROWS.get(plain, plain)]
    values = {
        "at rest by 2 s [%]": percent(one, "2"),
        "at rest by 4 s [%]": percent(one),
        "after [s]": [one["median_time_at_rest"]],
        "error at 1 s": one["error"]["1"],
        "error at 4 s": one["error"]["4"],
        "trace": one["trace_1_s"],
        "log det": one["log_det_1_s"],
        "greatest twist": one["greatest_twist_1_s"][1:],
        "rms u": [one["rms_u"]],
    }
    return values[column]


def harder(label: str, column: str) -> list[float]:
    """A cell of the table of harder conditions."""
    condition = CONDITIONS[label]
    known = methods("2_h200" if condition == "turn_0" else f"2_{condition}")
    name = METHODS[column]
    if name not in known:  # the file has other settings, too
        name += " forgetting=0.93 prior=0.0003"
    return percent(known[name])


def beyond(label: str, column: str) -> list[float]:
    """A cell of the table beyond the thesis."""
    file, name = BEYOND[label]
    one = methods(f"2_{file}")[name]
    return percent(one) if column.startswith("at rest") else [one["median_time_at_rest"]]


def initial(label: str, column: str) -> list[float]:
    """A cell of the table of figure 7-3."""
    kind, what = column.split(", ")
    deviation = {"0.01": "0.1", "0.1": "0.316", "1": "1.0", "10": "3.16"}[label]
    prior = "1e-06" if kind == "forgotten" else "0.0003"
    one = methods("3")[f"koopman_active deviation={deviation} prior={prior}"]
    return percent(one) if what.startswith("at rest") else [one["median_time_at_rest"]]


def speed(label: str, column: str) -> list[float]:
    """Decisions per second."""
    if column.startswith("H200"):
        return [SPEED[label]]
    return [1e6 / methods("2")[label]["microseconds_a_decision"]]


GAINS = [methods("2_gains")[f"koopman_active gain={gain}"] for gain in ("0.01", "0.33", "1.0")]
CITED = [
    Table(
        "method | at rest by 2 s [%] | at rest by 4 s [%] | after [s] | error at 1 s | "
        "error at 4 s | trace | log det | greatest twist | rms u",
        main,
    ),
    Text(
        "error at 1 s are # and # with a thirtieth of the gain, as without exploration, # and # "
        "with the gain of 0.33, and # and # with 1, where #% come to rest, after # s",
        [
            *(value for one in GAINS for value in (one["log_det_1_s"][0], one["error"]["1"][0])),
            percent(GAINS[2])[0],
            GAINS[2]["median_time_at_rest"],
        ],
    ),
    Text(
        "at most #% of the falls stop, whatever",
        [100 * max(map(max, SETTINGS["share"][SETTINGS["horizons"].index(16)]))],
    ),
    Table(" | active | noise | direct", harder),
    Table(" | at rest by 4 s [%] | after [s]", beyond),
    Text(
        "that is # falls of 4 s a second",
        [SETTINGS["trials_per_s"][SETTINGS["horizons"].index(128)]],
    ),
    Table(" | H200, 1,024 trials | two cores, 200 trials", speed),
    Table(
        "variance s^2 | forgotten, at rest [%] | forgotten, after [s] | prior mean, at rest [%] | "
        "prior mean, after [s]",
        initial,
    ),
]
PLAIN = [
    "200 falls (seeds 0 to 199) of 4 s",
    "up to 2 m/s and 2 rad/s",
    "at 200 Hz",
    "stays below 0.01.",
    "on seeds 1000 and above",
    "Wilson's 95% interval",
    "[10%, 90%] of the error after 1 s and 4 s, and medians after 1 s",
    "sum of |z|^2",
    "|v|^2 + |w|^2",
    "(90% of the trials are below)",
    "a horizon of 16 decisions (the thesis has 20)",
    "wind of 3 m/s^2",
    "100 trials of each setting",
    "Log det after 1 s and error at 1 s",
    "the gain of 0.33",
    "with 1, where",
    "1 / R~",
    "at rest by 4 s [%] of 200 trials",
    "jax 0.11",
    "learning ends after 1 s, the active",
    "within 0.4 s of the fault",
    "seeds 1000 to 1249, 10,000 falls",
    "horizon of 128",
    "1,024 trials on one H200, and with 200 trials",
    "for 10,000 trials compiles",
    "within 76 s",
    "a prior of 1e-6",
    "(3e-4, which",
    "s N(0, 1) dt",
    "K_0 = [I 0]",
    "200 trials, at rest by 4 s [%]",
    "rotor 1 loses",
    "by 4 s [%] and median",
]
