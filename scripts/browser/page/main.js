// The robots on the documentation's first page: window.runRobots(element), called by start.js.

import loadMujoco from "@mujoco/mujoco";
import { Picture } from "./picture.js";
import { World } from "./world.js";

const LONGEST = 0.1; // [s] of simulation between two pictures: a hidden tab does not catch up
const DOWN = 2; // [s] from the end of an episode to the next one
const STILL = 3; // [s] in which a robot that travels has moved by
const FAR = 0.2; // [m], or it lies on its back
const STIFFNESS = 40; // [N/m per kg] of the spring between pointer and robot
const GRAVITY = 9.81; // [m/s^2] a pull is at most the robot's weight

async function engine() {
  const bytes = Uint8Array.from(atob(window.MUJOCO_WASM_GZ), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return loadMujoco({ wasmBinary: await new Response(stream).arrayBuffer() });
}

class Page {
  constructor(mujoco, root) {
    this.mujoco = mujoco;
    this.root = root;
    this.stage = element("div", "robots-stage");
    this.picture = new Picture(mujoco, this.stage);
    this.status = element("output", "robots-status", "");
    this.command = element("code", "", "");
    this.hint = element("p", "robots-hint", "");
    this.buttons = Object.entries(window.ROBOTS).map(([name, { title }]) =>
      button(title, () => this.show(name), { name }));
    this.pauseButton = button("Pause", () => this.pause(!this.paused));
    const chooser = element("div", "robots-bar", ...this.buttons);
    const controls = element("div", "robots-bar", this.pauseButton,
      button("Reset", () => this.restart(this.start + 1)), this.status);
    this.commands = element("div", "robots-bar");
    const python = element("p", "robots-hint", "The same in Python: ", this.command);
    root.replaceChildren(chooser, this.stage, this.commands, controls, this.hint, python);
    this.listen();
    this.theme();
  }

  show(name) {
    this.world?.free();
    this.name = name;
    const definition = window.ROBOTS[name];
    this.world = new World(this.mujoco, definition);
    this.stats = { name, time: 0, decisions: 0, pushes: 0, falls: 0, x: 0, z: 0 };
    this.grabbed = null;
    this.restart(0);
    this.listenToCommands(definition.commands ?? {});
    this.picture.load(definition.models.scene, this.world.pose);
    for (const each of this.buttons) each.setAttribute("aria-pressed", each.dataset.name === name);
    this.picture.canvas.setAttribute("aria-label", `${definition.title}, simulated`);
    this.command.textContent = `python -m hybrid_rl.render policy=${name}`;
    const pull = this.world.model ? "Drag the robot to pull at it. " : "";
    this.hint.textContent = `${pull}Drag beside it to turn the view.`;
    this.pause(false);
  }

  // Sliders of what the robot is told; until one is moved, the episode has commands of its own.
  listenToCommands(commands) {
    const sliders = Object.entries(commands).map(([name, most]) => {
      const slider = element("input", "");
      Object.assign(slider, { type: "range", min: -most, max: most, step: most / 20, value: 0 });
      slider.addEventListener("input", () => {
        this.world.told = sliders.map(each => Number(each.value));
      });
      return slider;
    });
    const names = Object.keys(commands);
    const labels = sliders.map((slider, i) => element("label", "", names[i], " ", slider));
    this.commands.replaceChildren(...labels);
  }

  restart(start) {
    this.start = start;
    this.world.reset(start);
    this.before = this.after = this.world.pose;
    this.fraction = this.down = this.still = 0;
    this.from = this.after[0];
  }

  pause(paused) {
    this.paused = paused;
    this.pauseButton.textContent = paused ? "Run" : "Pause";
  }

  // One decision of the policy; then a new episode, if this one is over.
  decide() {
    const { world, stats } = this;
    const { dt, repeat, travels, limit } = world.definition;
    world.push = this.grabbed ? this.force() : null;
    world.decide();
    this.before = this.after;
    this.after = world.pose;
    const seconds = dt * repeat, [x] = this.after;
    stats.time += seconds;
    stats.decisions += 1;
    this.down = world.ended ? this.down + seconds : 0;
    this.still = Math.abs(x - this.from) < FAR ? this.still + seconds : 0;
    if (!this.still) this.from = x;
    const over = this.down > DOWN || (travels ? this.still > STILL : world.decisions >= limit);
    if (over && !this.grabbed) {
      stats.falls += Number(travels || world.ended);
      this.restart(this.start + 1);
    }
  }

  // The spring between the grabbed point and the pointer, at most the robot's weight.
  force() {
    const { at, to } = this.picture.grip(this.grabbed, this.pointer);
    const pull = to.clone().sub(at).multiplyScalar(STIFFNESS * this.world.mass);
    pull.clampLength(0, GRAVITY * this.world.mass);
    this.stats.pushes += 1;
    return { body: this.grabbed.body, at: at.toArray(), force: pull.toArray() };
  }

  frame(now) {
    const { world, picture, stats } = this;
    const passed = Math.min((now - this.last) / 1000, LONGEST);
    this.last = now;
    if (!this.paused) {
      const { dt, repeat } = world.definition;
      this.fraction += passed / (dt * repeat);
      for (; this.fraction >= 1; this.fraction -= 1) this.decide();
    }
    const pose = this.after.map((q, i) => this.before[i] + this.fraction * (q - this.before[i]));
    picture.pose(pose);
    picture.draw(this.grabbed && picture.grip(this.grabbed, this.pointer));
    Object.assign(stats, { x: picture.root.x, z: picture.root.z });
    const total = Math.round(world.total).toLocaleString("en");
    this.status.textContent = `decision ${world.decisions.toLocaleString("en")}, return ${total}`;
  }

  theme() {
    const chosen = document.body.dataset.theme;
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    this.picture.theme(chosen === "dark" || (chosen !== "light" && dark) ? "dark" : "light");
  }

  listen() {
    const { stage, picture } = this;
    const release = () => { this.grabbed = null; };
    // Before the controls of the camera, which listen at the canvas.
    stage.addEventListener("pointerdown", event => {
      this.pointer = event;
      this.grabbed = this.world.model ? picture.hit(event) : null;
      if (this.grabbed?.body >= this.world.model?.nbody) release(); // drawn, but not in the world
      if (!this.grabbed) return;
      event.stopPropagation();
      stage.setPointerCapture(event.pointerId);
    }, { capture: true });
    stage.addEventListener("pointermove", event => { this.pointer = event; });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
      stage.addEventListener(name, release);
    }
    // A finger on the robot pulls it; beside it, it scrolls the page.
    stage.addEventListener("touchstart", event => {
      if (this.world.model && picture.hit(event.touches[0])) event.preventDefault();
    }, { passive: false });
    const themes = new MutationObserver(() => this.theme());
    themes.observe(document.body, { attributeFilter: ["data-theme"] });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.theme());
    new IntersectionObserver(([entry]) => {
      this.visible = entry.isIntersecting;
      if (this.visible) this.run();
    }).observe(stage);
  }

  // Draw as long as the stage is in view.
  run() {
    if (this.running) return;
    this.running = true;
    const next = now => {
      this.running = this.visible;
      if (!this.visible) return;
      this.frame(now);
      requestAnimationFrame(next);
    };
    requestAnimationFrame(now => {
      this.last = now;
      next(now);
    });
  }
}

function element(kind, style, ...children) {
  const made = document.createElement(kind);
  if (style) made.className = style;
  made.append(...children);
  return made;
}

function button(title, action, data = {}) {
  const made = element("button", "", title);
  made.type = "button";
  Object.assign(made.dataset, data);
  made.addEventListener("click", action);
  return made;
}

// Returns the page, with which a test or a reader's console can run episodes, too.
window.runRobots = async root => {
  const page = new Page(await engine(), root);
  page.World = World;
  page.show(Object.keys(window.ROBOTS)[0]);
  return page;
};
