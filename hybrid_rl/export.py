"""A trained policy or planner as a file that runs without hybrid_rl.

    python -m hybrid_rl.export run=DIR out=policy.stablehlo
    python -m hybrid_rl.export run=DIR mode=full out=planner.stablehlo
    python -m hybrid_rl.export policy=halfcheetah out=policy.onnx

A .stablehlo is a program of JAX that runs where jax is installed, f = jax.export.deserialize(bytes)
with action = f.call(obs) for a policy. A controller that plans is

    action, state = f.call(obs, state, key)

state: [w] uint32, zeros at the start of an episode; key: [2] uint32, others at each decision. An
.onnx (`pip install "hybrid_rl[onnx]"`), obs [N, o] -> action [N, m], holds the layers of a
multilayer perceptron or of a linear policy. Both include the parameters and the normalisation of
the observations [o]. Actions are [m] in [-1, 1], of a Gymnasium environment or a robot within its
bounds, without exploration.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import POLICY, Argument, output, read, several, whole
from hybrid_rl.errors import UsageError, install, printable

SUFFIXES = (".stablehlo", ".onnx")
PLATFORMS = ("cpu", "cuda", "rocm", "tpu")
ARGUMENTS = (
    Argument("run", "", "folder of the run"),
    POLICY,
    Argument("out", "", "the file", needed="out=FILE.stablehlo or out=FILE.onnx"),
    Argument("mode", "policy", "policy: alone; full or planner: one that plans (.stablehlo)"),
    Argument("seed", None, "of a learner of the run; empty: the first", whole(least=0)),
    Argument("platforms", ["cpu"], f"of a .stablehlo: {', '.join(PLATFORMS)}", several(*PLATFORMS)),
)


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS, one=("run", "policy"))
    out = output("out", given["out"], SUFFIXES)
    from hybrid_rl.files.atomic import replacing
    from hybrid_rl.run import exported  # imports JAX, for seconds
    from hybrid_rl.run.saved import load_named

    trained = load_named(given)
    controller, params = trained.learner(given["seed"], given["mode"])
    spec = trained.episode.spec
    if parts := getattr(trained.episode.env, "parts", ""):
        flat = "gymnasium.spaces.flatten(env.observation_space, obs)"
        print(f"obs [{spec.obs}]: {printable(parts)}; {flat} makes it")
    if out.suffix == ".onnx":
        net = exported.layers(spec, controller, params)._replace(span=trained.span)
        try:
            exported.save_onnx(out, trained.task, spec, net)
        except ImportError as error:
            raise UsageError(f"out={out}: needs onnx; {install('onnx')}") from error
        print(f'{out}: onnxruntime.InferenceSession("{out.name}").run(None, {{"obs": obs[None]}})')
        return
    made = exported.program(spec, controller, params, given["platforms"], trained.span)
    with replacing(out) as draft:
        draft.write_bytes(made.serialize())
    print(f"{out}: {trained.task}, {given['mode']}, {', '.join(given['platforms'])}")
    print(f'  f = jax.jit(jax.export.deserialize(open("{out.name}", "rb").read()).call)')
    if len(made.in_avals) == 1:
        print(f"  action = f(obs)  # [{spec.obs}] -> [{spec.act}], float32")
        return
    size = made.in_avals[1].shape[0]
    print(f"  state = numpy.zeros({size}, numpy.uint32)  # at the start of an episode")
    print("  key = numpy.array([seed, decision], numpy.uint32)")
    print("  action, state = map(numpy.asarray, f(obs, state, key))  # the first call compiles")


if __name__ == "__main__":
    command.run(main)
