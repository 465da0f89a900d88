// Offers to run the trained robots in the element .robots of a page, and loads them on a click.
// Without WebAssembly or WebGL the element keeps the picture that it came with.
(() => {
  const here = document.currentScript.src;
  const root = document.querySelector(".robots");
  if (!root || !able()) return;
  const button = document.createElement("button");
  button.type = "button";
  button.className = "robots-start";
  button.textContent = "▶ Run trained robots here";
  button.title = "6 MB; they run in this page, without a server";
  root.append(button);
  button.addEventListener("click", async () => {
    button.disabled = true;
    button.textContent = "Loading ...";
    try {
      for (const name of ["mujoco.js", "robots.js", "robot.js"]) await load(new URL(name, here));
      window.robots = await window.runRobots(root);
    } catch (error) {
      button.textContent = "Could not be loaded";
      throw error;
    }
  });

  function able() {
    if (!window.WebAssembly || !window.DecompressionStream) return false;
    return document.createElement("canvas").getContext("webgl2") !== null;
  }

  function load(url) {
    return new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = url;
      script.onload = resolve;
      script.onerror = () => reject(new Error(`${url} cannot be loaded`));
      document.head.append(script);
    });
  }
})();
