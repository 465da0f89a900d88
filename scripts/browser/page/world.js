// A robot in its world: MuJoCo's steps, the environment's step and the policy, all as in Python.

const ACTIVATIONS = {
  relu: z => Math.max(z, 0),
  sin: Math.sin,
  tanh: Math.tanh,
  silu: z => z / (1 + Math.exp(-z)),
  elu: z => (z > 0 ? z : Math.expm1(z)),
  clip: z => Math.min(Math.max(z, -1), 1),
};

// u = squash(W_L a(... a(W_1 (o - mean) / scale + b_1) ...) + b_L)
export function perceptron({ mean, scale, sizes, activation, squash, weights }) {
  const bytes = Uint8Array.from(atob(weights), c => c.charCodeAt(0));
  const flat = new Float32Array(bytes.buffer);
  const layers = [];
  for (let l = 1, at = 0; l < sizes.length; l++) {
    const n = sizes[l - 1], m = sizes[l];
    const W = flat.subarray(at, at + n * m), b = flat.subarray(at + n * m, at + n * m + m);
    at += n * m + m;
    const f = ACTIVATIONS[l < sizes.length - 1 ? activation : squash];
    layers.push({ n, m, W, b, f });
  }
  return o => {
    let x = o.map((v, i) => (v - mean[i]) / scale[i]);
    for (const { n, m, W, b, f } of layers) {
      const y = Array.from(b);
      for (let i = 0; i < n; i++) for (let j = 0; j < m; j++) y[j] += x[i] * W[i * m + j];
      x = y.map(f);
    }
    return x;
  };
}

// One robot; `definition` is what scripts/browser/robots.py wrote.
export class World {
  constructor(mujoco, definition) {
    this.mujoco = mujoco;
    this.definition = definition;
    this.act = perceptron(definition.policy);
    if (definition.models.physics) {
      this.model = mujoco.MjModel.from_xml_string(definition.models.physics);
      this.data = new mujoco.MjData(this.model);
      this.mass = this.model.body_mass.reduce((a, b) => a + b);
    }
    this.reset(0);
  }

  // The first state of an episode.
  reset(start) {
    const { starts } = this.definition;
    const { s, o } = starts[start % starts.length];
    Object.assign(this, { s, o, reward: 0, total: 0, ended: false, decisions: 0 });
  }

  // The state after n steps from x = [qpos, qvel, act, warmstart, ctrl], and fields of mjData that
  // MuJoCo then computes at this state; in single precision.
  physics = (x, n, fields = []) => {
    const { model, data, mujoco } = this;
    const { nq, nv, na, nu } = model;
    let at = 0;
    const sizes = { qpos: nq, qvel: nv, act: na, qacc_warmstart: nv, ctrl: nu };
    for (const [name, size] of Object.entries(sizes)) {
      if (size) data[name].set(x.slice(at, at + size).map(Math.fround));
      at += size;
    }
    data.xfrc_applied.fill(0);
    if (this.push) this.pushed(this.push);
    for (let i = 0; i < n; i++) mujoco.mj_step(model, data);
    if (fields.length) mujoco.mj_forward(model, data);
    const after = ["qpos", "qvel", "act", "qacc_warmstart", ...fields];
    return after.flatMap(name => [...data[name]]).map(Math.fround);
  };

  // Apply a force [N] at a point of a body, in world coordinates.
  pushed({ body, at, force: [fx, fy, fz] }) {
    const { xipos, xfrc_applied } = this.data;
    const [x, y, z] = at.map((p, i) => p - xipos[3 * body + i]);
    const torque = [y * fz - z * fy, z * fx - x * fz, x * fy - y * fx];
    xfrc_applied.set([fx, fy, fz, ...torque], 6 * body);
  }

  // One decision: an action of the policy, repeated until the episode ends.
  decide() {
    if (this.told) Object.assign(this, this.definition.tell(this.s, this.o, this.told));
    const u = this.act(this.o);
    this.reward = 0;
    this.ended = false;
    for (let i = 0; i < this.definition.repeat && !this.ended; i++) {
      const { s, o, reward, ended } = this.definition.step(this.s, u, this.physics);
      Object.assign(this, { s, o, ended: Boolean(ended) });
      this.reward += reward;
    }
    this.total += this.reward;
    this.decisions += 1;
  }

  // Joint positions of the scene.
  get pose() {
    return this.definition.pose(this.s);
  }

  // Observations and rewards of the first decisions, and the return, of an episode not drawn.
  episode(start, kept = 0) {
    this.reset(start);
    const seen = [this.o], rewards = [];
    while (!this.ended && this.decisions < this.definition.limit) {
      this.decide();
      if (this.decisions > kept) continue;
      seen.push(this.o);
      rewards.push(this.reward);
    }
    return { seen, rewards, total: this.total, decisions: this.decisions };
  }

  free() {
    this.data?.delete();
    this.model?.delete();
  }
}
