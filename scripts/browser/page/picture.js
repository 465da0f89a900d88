// The scene of a robot as three.js draws it; positions come from MuJoCo's kinematics.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const CELL = 0.5; // [m] half the period of the ground's pattern
const GROUND = 12; // [m] radius of the ground around the robot, which fog hides at its rim
const LEVEL = 0.2; // of the distance to the robot: a rise that hardly moves the camera,
const SHAKEN = 0.1; // by this share of it
const SHOWN = 2; // last group of geometries that is drawn, as in MuJoCo's viewer

// A geometry of MuJoCo, whose long axis is z.
function shape(mujoco, kind, [a, b, c]) {
  const type = name => mujoco.mjtGeom[`mjGEOM_${name}`].value;
  switch (kind) {
    case type("SPHERE"): return new THREE.SphereGeometry(a, 32, 16);
    case type("CAPSULE"): return new THREE.CapsuleGeometry(a, 2 * b, 8, 24).rotateX(Math.PI / 2);
    case type("CYLINDER"): return new THREE.CylinderGeometry(a, a, 2 * b, 32).rotateX(Math.PI / 2);
    case type("BOX"): return new THREE.BoxGeometry(2 * a, 2 * b, 2 * c);
    case type("ELLIPSOID"): return new THREE.SphereGeometry(1, 32, 16).scale(a, b, c);
    default: return null;
  }
}

// A pattern of two grey squares, which repeats.
function checker(bright, dark) {
  const data = new Uint8Array([bright, dark, dark, bright].flatMap(c => [...c, 255]));
  const texture = new THREE.DataTexture(data, 2, 2);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.repeat.setScalar(GROUND / CELL);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.generateMipmaps = true;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}

const THEMES = {
  light: {
    sky: 0xf4f6f8, squares: [[232, 235, 239], [217, 222, 227]], shadow: 0.28, sun: 1.9, air: 1.7,
  },
  dark: { sky: 0x15191e, squares: [[38, 44, 51], [29, 34, 40]], shadow: 0.6, sun: 1.7, air: 1.0 },
};

export class Picture {
  constructor(mujoco, stage) {
    this.mujoco = mujoco;
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.canvas = this.renderer.domElement;
    stage.append(this.canvas);
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.05, 60);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableZoom = this.controls.enablePan = false; // the wheel scrolls the page
    this.canvas.style.touchAction = "pan-y"; // and so does a finger, upwards
    this.scene = new THREE.Scene();
    this.robot = new THREE.Group();
    this.air = new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1);
    this.sun = new THREE.DirectionalLight(0xffffff, 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.setScalar(1024);
    this.sun.shadow.normalBias = 0.02; // or round surfaces shade themselves in stripes
    const lit = { left: -3, right: 3, top: 3, bottom: -3, near: 1, far: 16 }; // [m]
    Object.assign(this.sun.shadow.camera, lit);
    this.ground = new THREE.Group();
    const disc = new THREE.CircleGeometry(GROUND, 64);
    this.floor = new THREE.Mesh(disc, new THREE.MeshBasicMaterial());
    this.shade = new THREE.Mesh(disc, new THREE.ShadowMaterial());
    this.shade.position.z = 0.001;
    this.shade.receiveShadow = true;
    this.ground.add(this.floor, this.shade);
    const red = new THREE.LineBasicMaterial({ color: 0xd1495b, depthTest: false });
    const zero = new THREE.Vector3();
    this.pull = new THREE.Line(new THREE.BufferGeometry().setFromPoints([zero, zero]), red);
    this.pull.frustumCulled = false;
    this.pull.renderOrder = 1;
    this.scene.add(this.robot, this.air, this.sun, this.sun.target, this.ground, this.pull);
    new ResizeObserver(() => this.resize(stage)).observe(stage);
    this.resize(stage);
  }

  resize({ clientWidth, clientHeight }) {
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
  }

  theme(name) {
    const { sky, squares, shadow, sun, air } = THEMES[name];
    this.scene.background = new THREE.Color(sky);
    this.scene.fog = new THREE.Fog(sky, 5, GROUND);
    this.floor.material.map?.dispose();
    this.floor.material.map = checker(...squares);
    this.floor.material.needsUpdate = true;
    this.shade.material.opacity = shadow;
    this.sun.intensity = sun;
    this.air.intensity = air;
  }

  // Draw another model; the camera is the one that the model calls track.
  load(xml, qpos) {
    const { mujoco, robot } = this;
    for (const mesh of robot.children) {
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    robot.clear();
    this.data?.delete();
    this.model?.delete();
    const model = this.model = mujoco.MjModel.from_xml_string(xml);
    const data = this.data = new mujoco.MjData(model);
    data.qpos.set(qpos);
    mujoco.mj_forward(model, data);
    this.ground.position.z = 0;
    for (let i = 0; i < model.ngeom; i++) this.geometry(i);
    const eye = new THREE.Vector3(...data.cam_xpos.slice(0, 3));
    const [, , x, , , y, , , z] = data.cam_xmat.slice(0, 9);
    const ahead = new THREE.Vector3(-x, -y, -z);
    this.root = new THREE.Vector3(...data.xpos.slice(3, 6));
    this.follows = model.cam_mode[0] !== mujoco.mjtCamLight.mjCAMLIGHT_FIXED.value;
    this.camera.fov = model.cam_fovy[0];
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(eye);
    const depth = this.root.clone().sub(eye).dot(ahead);
    Object.assign(this, { rest: this.root.z, lift: 0, band: LEVEL * depth });
    this.controls.target.copy(eye).addScaledVector(ahead, depth);
    this.controls.maxPolarAngle = Math.PI / 2;
    this.controls.update();
  }

  geometry(i) {
    const { mujoco, model } = this;
    if (model.geom_group[i] > SHOWN) return;
    if (model.geom_type[i] === mujoco.mjtGeom.mjGEOM_PLANE.value) {
      this.ground.position.z = model.geom_pos[3 * i + 2];
      return;
    }
    const geometry = shape(mujoco, model.geom_type[i], model.geom_size.slice(3 * i, 3 * i + 3));
    if (!geometry) return;
    const coat = model.geom_matid[i];
    const [r, g, b, a] = coat < 0
      ? model.geom_rgba.slice(4 * i, 4 * i + 4) : model.mat_rgba.slice(4 * coat, 4 * coat + 4);
    const material = new THREE.MeshStandardMaterial({
      color: new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace),
      roughness: 0.55, metalness: 0.05, opacity: a, transparent: a < 1,
      polygonOffset: true, polygonOffsetFactor: i % 7, polygonOffsetUnits: i % 7, // no flicker
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.matrixAutoUpdate = false;
    mesh.userData = { geom: i, body: model.geom_bodyid[i] };
    this.robot.add(mesh);
  }

  // Move the model to joint positions, and the camera with it.
  pose(qpos) {
    const { mujoco, model, data, controls, camera, ground, sun } = this;
    data.qpos.set(qpos);
    mujoco.mj_kinematics(model, data);
    const { geom_xpos: p, geom_xmat: R } = data;
    for (const mesh of this.robot.children) {
      const i = 3 * mesh.userData.geom, j = 9 * mesh.userData.geom;
      mesh.matrix.set(
        R[j], R[j + 1], R[j + 2], p[i],
        R[j + 3], R[j + 4], R[j + 5], p[i + 1],
        R[j + 6], R[j + 7], R[j + 8], p[i + 2],
        0, 0, 0, 1);
      mesh.matrixWorldNeedsUpdate = true;
    }
    const root = new THREE.Vector3(...data.xpos.slice(3, 6));
    const moved = this.follows ? root.clone().sub(this.root) : new THREE.Vector3();
    if (this.follows) {
      moved.z = this.lifted(root.z - this.rest) - this.lift;
      this.lift += moved.z;
    }
    camera.position.add(moved);
    controls.target.add(moved);
    this.root = root;
    controls.update();
    const jump = x => 2 * CELL * Math.round(x / (2 * CELL));
    ground.position.set(jump(root.x), jump(root.y), ground.position.z);
    sun.target.position.copy(controls.target);
    sun.position.copy(controls.target).add(new THREE.Vector3(-1.5, -2.5, 6));
    camera.updateMatrixWorld();
  }

  // How far the camera rises with a robot that rose by z: a jump does not shake it, a flight counts.
  lifted(z) {
    return z - (1 - SHAKEN) * Math.min(Math.max(z, -this.band), this.band);
  }

  // Draw, with a line from a grabbed point to the pointer that pulls it.
  draw(pull) {
    this.pull.visible = Boolean(pull);
    if (pull) this.pull.geometry.setFromPoints([pull.at, pull.to]);
    this.renderer.render(this.scene, this.camera);
  }

  // The ray through a point of the window.
  ray({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    const x = (clientX - box.left) / box.width, y = (clientY - box.top) / box.height;
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), this.camera);
    return caster;
  }

  // The body under a point of the window, and where on it, in its frame.
  hit(event) {
    const [found] = this.ray(event).intersectObjects(this.robot.children);
    const body = found?.object.userData.body;
    if (!body) return null;
    return { body, local: found.point.clone().applyMatrix4(this.frame(body).invert()) };
  }

  // World coordinates of a grabbed point, and of the point of the window that pulls it.
  grip({ body, local }, event) {
    const at = local.clone().applyMatrix4(this.frame(body));
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(ahead, at);
    const to = this.ray(event).ray.intersectPlane(plane, new THREE.Vector3()) ?? at;
    return { at, to };
  }

  frame(body) {
    const { xpos: p, xmat: R } = this.data, i = 3 * body, j = 9 * body;
    return new THREE.Matrix4().set(
      R[j], R[j + 1], R[j + 2], p[i], R[j + 3], R[j + 4], R[j + 5], p[i + 1],
      R[j + 6], R[j + 7], R[j + 8], p[i + 2], 0, 0, 0, 1);
  }

  // Where a point of the world is in the window.
  window(point) {
    const box = this.canvas.getBoundingClientRect(), p = point.clone().project(this.camera);
    return { x: box.left + (1 + p.x) / 2 * box.width, y: box.top + (1 - p.y) / 2 * box.height };
  }
}
