"use strict";

// Tables: a click on a head sorts by that column, a second one the other way; empty cells come last.
for (const button of document.querySelectorAll("th button")) {
  button.addEventListener("click", () => {
    const head = button.closest("th"), table = head.closest("table"), column = head.cellIndex;
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
    const numeric = head.classList.contains("number");
    const order = (a, b) => {
      const [x, y] = [key(a), key(b)];
      if (x === "" || y === "") return (x === "") - (y === "");
      const sign = numeric ? Number(x) - Number(y) : x.localeCompare(y);
      return down ? -sign : sign;
    };
    const body = table.tBodies[0];
    body.append(...Array.from(body.rows).sort(order));
  });
}

// Curves in space, turned by mouse, touch or arrow keys. Each canvas names its curves in a script of JSON beside it.
for (const canvas of document.querySelectorAll("canvas[data-curves]")) {
  const curves = JSON.parse(document.getElementById(canvas.dataset.curves).textContent);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const reach = Math.max(...curves.flatMap(curve => curve.points.map(point => Math.hypot(...point))));
  let yaw = 0.7, pitch = 0.5, held = null;

  function seen([x, y, z]) {
    const [cy, sy, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
    const right = cy * y - sy * x, forward = cy * x + sy * y;
    return [right, cp * z - sp * forward, cp * forward + sp * z];
  }

  function draw() {
    const size = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
    canvas.width = canvas.height = size;
    const pen = canvas.getContext("2d"), scale = 0.44 * size / reach;
    const place = ([x, y]) => [size / 2 + scale * x, size / 2 - scale * y];
    pen.clearRect(0, 0, size, size);
    pen.lineCap = "round";
    const inks = curves.map(curve => (dark.matches ? curve.dark : curve.light));
    curves.forEach((curve, index) => {
      const points = curve.points.map(seen);
      for (let k = 1; k < points.length; k++) {
        // what is behind is drawn faintly
        const behind = points[k][2] + points[k - 1][2] < 0;
        pen.globalAlpha = curve.sphere && behind ? 0.22 : 1;
        pen.strokeStyle = inks[index];
        pen.lineWidth = curve.width * size / 500;
        pen.beginPath();
        pen.moveTo(...place(points[k - 1]));
        pen.lineTo(...place(points[k]));
        pen.stroke();
      }
    });
    // names after all curves
    pen.globalAlpha = 1;
    pen.font = `${Math.round(size / 28)}px system-ui, sans-serif`;
    curves.forEach((curve, index) => {
      if (!curve.name) return;
      const [x, y] = place(seen(curve.points[curve.points.length - 1]));
      const left = Math.min(Math.max(x + 6, 4), size - pen.measureText(curve.name).width - 4);
      const base = Math.min(Math.max(y - 6, size / 24), size - 6);
      // a rim of the page's colour keeps the name readable over curves
      pen.strokeStyle = getComputedStyle(document.body).backgroundColor;
      pen.lineWidth = size / 90;
      pen.strokeText(curve.name, left, base);
      pen.fillStyle = inks[index];
      pen.fillText(curve.name, left, base);
    });
    canvas.dataset.drawn = curves.length;
  }

  const turn = (right, up) => {
    yaw -= right;
    pitch = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, pitch + up));
    draw();
  };
  canvas.addEventListener("pointerdown", event => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", event => {
    if (!held) return;
    turn((event.clientX - held[0]) / 120, (event.clientY - held[1]) / 120);
    held = [event.clientX, event.clientY];
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => { held = null; });
  canvas.addEventListener("keydown", event => {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    if (event.key in turns) { event.preventDefault(); turn(...turns[event.key]); }
  });
  addEventListener("resize", draw);
  dark.addEventListener("change", draw);
  draw();
}

// For the test of the layout: whether anything is wider than the window.
document.documentElement.dataset.overflow = document.documentElement.scrollWidth - innerWidth;
