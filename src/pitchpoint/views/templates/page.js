"use strict";
(function () {
  const page = JSON.parse(document.getElementById("figures").textContent);
  const config = { displayModeBar: false, responsive: true, showTips: false };
  const touch = window.matchMedia("(pointer: coarse)").matches;
  const drawn = new Map();

  function draw(place) {
    if (drawn.has(place.id)) return drawn.get(place.id);
    const figure = page.figures[place.id];
    // A finger scrolls the page, so it must not start a zoom.
    if (touch) figure.layout.dragmode = false;
    const off = hidden();
    for (const trace of figure.data) trace.visible = !off.has(trace.meta);
    drawn.set(place.id, Plotly.newPlot(place, figure.data, figure.layout, config));
    return drawn.get(place.id);
  }

  function hidden() {
    const boxes = document.querySelectorAll("[data-curve]:not(:checked)");
    return new Set([...boxes].map((box) => box.dataset.curve));
  }

  function show(key, on) {
    for (const box of document.querySelectorAll("[data-curve]")) {
      if (box.dataset.curve === key) box.checked = on;
    }
    for (const [id, ready] of drawn) {
      const traces = page.figures[id].data;
      const which = traces.map((trace, k) => (trace.meta === key ? k : -1)).filter((k) => k >= 0);
      if (which.length) ready.then((place) => Plotly.restyle(place, { visible: on }, which));
    }
  }

  function choose(menu) {
    const changes = page.menus[menu.dataset.menu][menu.value];
    for (const [id, change] of Object.entries(changes)) {
      const place = document.getElementById(id);
      if (place) draw(place).then(() => Plotly.update(place, ...change));
    }
  }

  function animate(mesh) {
    const motion = JSON.parse(mesh.dataset.motion);
    const input = mesh.querySelector("input");
    const button = mesh.querySelector("button");
    const gears = mesh.querySelectorAll(".close .gear");
    const contacts = mesh.querySelectorAll(".contact");
    const plane = mesh.querySelector(".plane");
    const zone = JSON.parse(plane.dataset.motion);

    function between(place) {
      const points = motion.points;
      for (let k = 1; k < points.length; k++) {
        if (place <= points[k][1] + 1e-9) return points[k - 1][0] + " to " + points[k][0];
      }
      return "";
    }

    function set() {
      const phase = Number(input.value);
      for (const gear of gears) {
        const turn = Number(gear.dataset.turn) + phase * Number(gear.dataset.spin);
        gear.setAttribute("transform", `translate(0 ${gear.dataset.centre}) rotate(${turn})`);
      }
      const places = [];
      contacts.forEach((contact, lane) => {
        const place = phase + lane - motion.behind;
        const touches = place >= -1e-9 && place <= motion.ratio + 1e-9;
        contact.setAttribute("visibility", touches ? "visible" : "hidden");
        contact.setAttribute("cx", motion.start[0] + motion.step[0] * (phase + lane));
        contact.setAttribute("cy", motion.start[1] + motion.step[1] * (phase + lane));
        if (touches) places.push(place.toFixed(2) + (motion.behind ? "" : " (" + between(place) + ")"));
      });
      const pairs = lines(phase);
      const where = motion.behind ? "; in this section at base pitches from A: " : ", base pitches from A: ";
      mesh.querySelector("output").textContent =
        "phase " + phase.toFixed(2) + ": " + (pairs === 1 ? "1 pair" : pairs + " pairs") + " in contact" +
        where + (places.join(", ") || "none");
    }

    // Parts of the face between which the line of a pair touches.
    function ends(entered) {
      if (entered > zone.alpha + zone.beta + 1e-9) return null;
      if (!zone.beta) return [0, 1];
      return [Math.max((entered - zone.alpha) / zone.beta, 0), Math.min(entered / zone.beta, 1)];
    }

    function lines(phase) {
      const drawn = plane.querySelectorAll(".contact-line");
      const dots = plane.querySelectorAll(".crossing");
      const names = plane.querySelectorAll(".pair");
      let length = 0;
      let count = 0;
      drawn.forEach((line, lane) => {
        const entered = phase + lane;
        const found = ends(entered);
        const at = (share) => [share * zone.width, -(entered - zone.beta * share) * zone.pitch];
        const middle = entered - zone.beta / 2;
        const crosses = found && zone.beta && middle >= -1e-9 && middle <= zone.alpha + 1e-9;
        for (const one of [line, names[lane]]) one.setAttribute("visibility", found ? "visible" : "hidden");
        dots[lane].setAttribute("visibility", crosses ? "visible" : "hidden");
        if (!found) return;
        count += 1;
        length += ((found[1] - found[0]) * zone.width) / zone.slope;
        const [first, last, half] = [at(found[0]), at(found[1]), at(0.5)];
        for (const [name, value] of [["x1", first[0]], ["y1", first[1]], ["x2", last[0]], ["y2", last[1]]]) {
          line.setAttribute(name, value);
        }
        dots[lane].setAttribute("cx", half[0]);
        dots[lane].setAttribute("cy", half[1]);
        const part = (share) => found[0] + (found[1] - found[0]) * share;
        const [x, y] = at(Math.abs(part(0.2) - 0.5) < 0.05 ? part(0.8) : part(0.2));
        names[lane].setAttribute("x", x);
        names[lane].setAttribute("y", y);
        names[lane].setAttribute("dy", ".35em");
      });
      mesh.querySelector(".now").textContent = length.toPrecision(4) + " mm now;";
      return count;
    }

    let timer = 0;
    button.addEventListener("click", () => {
      if (timer) {
        clearInterval(timer);
        timer = 0;
      } else {
        timer = setInterval(() => {
          const next = Number(input.value) + motion.direction / 48;
          input.value = next >= 1 ? next - 1 : next < 0 ? next + 1 : next;
          set();
        }, 60);
      }
      button.textContent = timer ? "Stop" : "Play";
    });
    input.addEventListener("input", set);
    input.value = 0.25;
    set();
  }

  const places = [...document.querySelectorAll(".plot")];
  if ("IntersectionObserver" in window) {
    const watch = new IntersectionObserver(
      (entries) => entries.filter((entry) => entry.isIntersecting).forEach((entry) => draw(entry.target)),
      { rootMargin: "600px" }
    );
    places.forEach((place) => watch.observe(place));
  } else {
    places.forEach(draw);
  }
  // The rest follows while nobody waits for it, so that a printed page is complete.
  const later = places.slice();
  (function next() {
    const place = later.shift();
    if (place) draw(place).then(() => setTimeout(next, 30));
  })();
  document.querySelectorAll("[data-curve]").forEach((box) =>
    box.addEventListener("change", () => show(box.dataset.curve, box.checked))
  );
  document.querySelectorAll("[data-menu]").forEach((menu) => {
    menu.addEventListener("change", () => choose(menu));
    menu.value = "0";
  });
  document.querySelectorAll(".mesh").forEach(animate);
  window.addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((one) => (one.open = true));
    places.forEach((place) => draw(place).then(() => Plotly.relayout(place, { width: 340, height: 230 })));
  });
  window.addEventListener("afterprint", () => {
    places.forEach((place) => Plotly.relayout(place, { width: null, height: null, autosize: true }));
  });
})();
