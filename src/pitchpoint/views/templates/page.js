"use strict";
(async function () {
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const page = JSON.parse(document.getElementById("figures").textContent, dressed);
  const config = { displayModeBar: false, responsive: true, showTips: false };
  const touch = window.matchMedia("(pointer: coarse)").matches;
  const drawn = new Map();
  const seen = document.documentElement.dataset;

  // Colours are given for white paper; on dark paper light and dark change places, hues stay.
  function lit(colour) {
    const full = colour.length === 4 ? colour.replace(/[0-9a-f]/gi, "$&$&") : colour;
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(full.slice(at, at + 2), 16) / 255);
    const [low, high] = [Math.min(r, g, b), Math.max(r, g, b)];
    const [light, span] = [(low + high) / 2, high - low];
    const share = span ? span / (1 - Math.abs(2 * light - 1)) : 0;
    const [first, second] = high === r ? [g - b, 0] : high === g ? [b - r, 2] : [r - g, 4];
    const hue = span ? 60 * (first / span + second) : 0;
    return `hsl(${hue.toFixed(0)}, ${(80 * share).toFixed(0)}%, ${(100 - 88 * light).toFixed(0)}%)`;
  }

  function dressed(key, value) {
    if (dark.matches && key.endsWith("bgcolor")) return getComputedStyle(document.body).getPropertyValue("--paper").trim();
    const colour = dark.matches && typeof value === "string" && /^#([0-9a-f]{3}){1,2}$/i.test(value);
    return colour && key !== "name" && key !== "text" ? lit(value) : value;
  }

  if (dark.matches) {
    for (const one of document.querySelectorAll('[stroke^="#"], [fill^="#"], [style*="#"]')) {
      for (const name of ["stroke", "fill", "style"]) {
        const value = one.getAttribute(name);
        if (value) one.setAttribute(name, value.replace(/#[0-9a-f]{6}\b/gi, lit));
      }
    }
  }
  dark.addEventListener("change", () => location.reload());

  async function unpack(id) {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (one) => one.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
  }

  function draw(place) {
    if (drawn.has(place.id)) return drawn.get(place.id);
    const figure = structuredClone(page.figures[place.dataset.figure || place.id]);
    // A finger scrolls the page, so it must not start a zoom.
    if (touch) figure.layout.dragmode = false;
    const off = hidden();
    for (const trace of figure.data) trace.visible = !off.has(trace.meta);
    offer(place);
    const ready = Plotly.newPlot(place, figure.data, figure.layout, config).then(() => {
      tell(place);
      seen.drawn = seen.drawn || "some";
      return place;
    });
    drawn.set(place.id, ready);
    return ready;
  }

  const minus = (number) => String(number).replace(/-/g, "\u2212");
  const bare = (words) => new DOMParser().parseFromString(words || "", "text/html").body.textContent;
  const heading = (place) => place.closest("figure").querySelector("figcaption").dataset.title;

  // Title, axes with their ranges and curves of a figure, for those who do not see it.
  function tell(place) {
    const layout = place._fullLayout;
    const axis = (name) => {
      const one = layout[name];
      if (!one || !one.range || !one.title) return "";
      const places = one.range.map((end) => (one.type === "log" ? 10 ** end : end));
      const digits = Math.floor(Math.log10(Math.abs(places[1] - places[0]) || 1));
      const ends = places.map((end) => minus(Number(end.toFixed(Math.min(Math.max(3 - digits, 0), 20)))));
      return `, ${bare(one.title.text)} from ${ends.join(" to ")}`;
    };
    const curves = [...new Set(place.data.map((trace) => bare(trace.name)).filter(Boolean))];
    const told = curves.length ? ". Curves: " + curves.slice(0, 12).join(", ") : "";
    place.setAttribute("role", "img");
    place.setAttribute("aria-label", heading(place) + axis("xaxis") + axis("yaxis") + told + ".");
  }

  // Buttons that save a figure as it is shown.
  function offer(place) {
    const caption = place.closest("figure").querySelector("figcaption");
    caption.dataset.title = caption.textContent.trim();
    const group = document.createElement("span");
    group.className = "save";
    for (const kind of ["svg", "png", "csv"]) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = kind.toUpperCase();
      button.setAttribute("aria-label", `Save ${caption.dataset.title} as ${button.textContent}`);
      button.addEventListener("click", () => save(place, kind));
      group.append(button);
    }
    caption.append(group);
  }

  async function save(place, kind) {
    const [width, height] = [place.clientWidth, place.clientHeight];
    const address =
      kind === "csv"
        ? URL.createObjectURL(new Blob([table(place)], { type: "text/csv" }))
        : await Plotly.toImage(place, { format: kind, width, height, scale: kind === "png" ? 3 : 1 });
    const link = document.createElement("a");
    link.href = address;
    link.download = `${place.id}.${kind}`;
    link.click();
    if (kind === "csv") setTimeout(() => URL.revokeObjectURL(address), 1000);
  }

  // Values of the curves that are shown, one point a line.
  function table(place) {
    const cell = (value) => {
      if (value === null || value === undefined) return "";
      if (typeof value === "number") return String(value);
      const words = bare(String(value)).replace(/^[=+@-]/, "'$&");
      return `"${words.replace(/"/g, '""')}"`;
    };
    const title = (name) => bare(place.layout[name] && place.layout[name].title && place.layout[name].title.text);
    const maps = place.data.some((trace) => trace.z);
    const value = maps ? [heading(place)] : [];
    const rows = [["curve", title("xaxis") || "x", title("yaxis") || "y", ...value]];
    for (const trace of place.data.filter((one) => one.visible !== false)) {
      const name = bare(trace.name);
      if (!trace.z) trace.x.forEach((x, k) => rows.push([name, x, trace.y[k], ...value.map(() => "")]));
      else trace.z.forEach((line, row) => line.forEach((z, column) => rows.push([name, trace.x[column], trace.y[row], z])));
    }
    return "\ufeff" + rows.map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
  }

  function hidden() {
    const boxes = document.querySelectorAll("[data-curve]:not(:checked)");
    return new Set([...boxes].map((box) => box.dataset.curve));
  }

  function show(key, on) {
    for (const box of document.querySelectorAll("[data-curve]")) {
      if (box.dataset.curve === key) box.checked = on;
    }
    for (const ready of drawn.values()) {
      ready.then((place) => {
        const which = place.data.map((trace, k) => (trace.meta === key ? k : -1)).filter((k) => k >= 0);
        if (which.length) Plotly.restyle(place, { visible: on }, which);
      });
    }
  }

  function choose(menu) {
    if (menu.dataset.labels) {
      menu.closest(".slider").querySelector("output").textContent = menu.dataset.labels.split(" ")[menu.value];
    }
    const name = menu.dataset.menu;
    const parts = [...document.querySelectorAll(`[data-menu="${CSS.escape(name)}"]`)];
    const chosen = parts.reduce((sum, one) => sum + Number(one.value) * Number(one.dataset.step || 1), 0);
    const changes = page.menus[name][chosen];
    for (const [id, change] of Object.entries(changes)) {
      const place = document.getElementById(id);
      if (place) draw(place).then(() => Plotly.update(place, ...change)).then(() => tell(place));
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
        const [x, y] = gear.dataset.place.split(" ").map(Number);
        const [across, down] = gear.dataset.travel.split(" ").map(Number);
        const place = `${x + phase * across} ${y + phase * down}`;
        gear.setAttribute("transform", `translate(${place}) rotate(${turn})`);
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
      if (!zone.beta) return zone.ends;
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
        const beside = found[1] - found[0] < 0.1 && !zone.beta;
        const inside = Math.abs(part(0.2) - 0.5) < 0.05 ? part(0.8) : part(0.2);
        const [x, y] = at(beside ? found[1] + 0.04 : inside);
        names[lane].setAttribute("x", x);
        names[lane].setAttribute("y", y);
        names[lane].setAttribute("dy", ".35em");
      });
      const now = mesh.querySelector(".now");
      if (now) now.textContent = (motion.of_mm * length).toPrecision(4) + " " + motion.unit + " now;";
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

  // A drive whose teeth are carried by a wave: every tooth is placed on the deformed neutral line.
  function drive(place) {
    const it = JSON.parse(place.dataset.motion);
    const [z1, z2] = it.teeth;
    const turn = place.querySelector(".turn");
    const where = place.querySelector(".place");
    const whole = place.querySelector(".whole");
    const close = place.querySelector(".close");
    const output = place.querySelector("output");
    const told = place.querySelector(".where");
    const deg = 180 / Math.PI;
    let factor = 1;

    function make(name, parent, attributes) {
      const made = document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      parent.appendChild(made);
      return made;
    }

    // Radial displacement, shift along the circumference and tilt of the normal at an angle p.
    function deformed(p) {
      let [w, v, tilt] = [0, 0, 0];
      it.weights.forEach((weight, k) => {
        const n = 2 * (k + 1);
        w += weight * Math.cos(n * p);
        v -= (weight * Math.sin(n * p)) / n;
        tilt += weight * n * Math.sin(n * p);
      });
      return [it.deflection * w, it.deflection * v, it.deflection * tilt];
    }

    // Foot of a tooth and direction of its axis; the long axis stays in place under any factor.
    function foot(p, by) {
      const [w, v, tilt] = deformed(p);
      return [it.radius + it.deflection + by * (w - it.deflection), p + v / it.radius, (by * tilt) / it.radius];
    }

    const at = (radius, angle) => [-radius * Math.sin(angle), -radius * Math.cos(angle)];
    const joined = (points) => points.map((one) => one[0].toFixed(4) + " " + one[1].toFixed(4)).join("L");

    // Line at a height above the neutral line, between two angles p, seen from an angle.
    function beside(height, low, high, count, by, seen) {
      const points = [];
      for (let k = 0; k <= count; k++) {
        const p = low + ((high - low) * k) / count;
        const [reach, polar, tilt] = foot(p, by);
        const [x, y] = at(reach, polar - seen);
        const [dx, dy] = at(height, polar + tilt - seen);
        points.push([x + dx, y + dy]);
      }
      return points;
    }

    const across = (corners) => corners.map(([a, b]) => [-a, -b]);
    const tooth = "M" + joined(across(it.tooth)) + "Z";
    let rim = "";
    for (let j = 0; j < z2; j++) {
      const [c, s] = [Math.cos((2 * Math.PI * j) / z2), Math.sin((2 * Math.PI * j) / z2)];
      rim += (j ? "L" : "M") + joined(it.space.map(([a, b]) => [-(a * c + b * s), -(b * c - a * s)]));
    }
    const r = it.outside;
    rim += `ZM${r} 0A${r} ${r} 0 1 0 ${-r} 0A${r} ${r} 0 1 0 ${r} 0Z`;
    const name = "tooth-" + Math.random().toString(36).slice(2);
    make("path", make("defs", whole, {}), { id: name, d: tooth });

    const scenes = [
      { svg: whole, first: 0, count: z1 },
      { svg: close, first: -Math.ceil(it.width / 2) - 2, count: 2 * Math.ceil(it.width / 2) + 5 },
    ];
    for (const scene of scenes) {
      scene.circular = make("path", scene.svg, { class: "circular", "fill-rule": "evenodd", d: rim });
      scene.generator = make("path", scene.svg, { class: "generator" });
      scene.band = make("path", scene.svg, { class: "flexible", "fill-rule": "evenodd" });
      scene.axis = make("line", scene.svg, { class: "axis" });
      scene.teeth = Array.from({ length: scene.count }, () =>
        make("use", scene.svg, { href: "#" + name, class: "flexible" })
      );
    }
    const [x, y, wide, high] = close.getAttribute("viewBox").split(" ").map(Number);
    const frame = make("rect", whole, { class: "frame", x, y, width: wide, height: high });

    // Angle from the nearest end of the long axis.
    const near = (p) => p - Math.PI * Math.round(p / Math.PI);
    const carries = (p) => it.arcs.some(([low, high]) => near(p) >= low && near(p) <= high);

    function paint(scene, rates, by, seen, middle, half) {
      const [wave, flexible, circular] = rates;
      const pitch = (2 * Math.PI) / z1;
      const start = Math.round((wave + middle - flexible) / pitch) + scene.first;
      scene.circular.setAttribute("transform", `rotate(${-(circular - seen) * deg})`);
      scene.teeth.forEach((one, k) => {
        const p = flexible + (start + k) * pitch - wave;
        const [reach, polar, tilt] = foot(p, by);
        const [x, y] = at(reach, polar + wave - seen);
        one.setAttribute("transform", `translate(${x} ${y}) rotate(${-(polar + tilt + wave - seen) * deg})`);
        one.setAttribute("class", carries(p) ? "carries" : "flexible");
      });
      const count = half < 3 ? 60 : 360;
      const ends = [middle - half, middle + half, count, by, seen - wave];
      const inner = beside(-it.rim / 2, ...ends);
      const outer = beside(it.root, ...ends);
      const part = half < 3; // of the flexspline; else all of it
      const between = part ? "L" : "ZM";
      scene.band.setAttribute("d", "M" + joined(outer) + between + joined(inner.reverse()) + "Z");
      scene.generator.setAttribute("d", "M" + joined(inner) + (part ? "L0 0Z" : "Z"));
      const [ax, ay] = at(it.outside, wave - seen);
      for (const [key, value] of [["x1", ax], ["y1", ay], ["x2", -ax], ["y2", -ay]]) scene.axis.setAttribute(key, value);
    }

    function set() {
      const angle = Number(turn.value) / deg;
      const rates = it.rates.map((rate) => rate * angle);
      const middle = Number(where.value) / deg;
      paint(scenes[0], rates, factor, 0, 0, Math.PI);
      paint(scenes[1], rates, 1, rates[0] + middle, middle, (it.width * 2 * Math.PI) / z1);
      frame.setAttribute("transform", `rotate(${-(rates[0] + middle) * deg})`);
      output.textContent = it.members.map((one, k) => one + " " + sign((rates[k] * deg).toFixed(2)) + "°").join(", ");
      told.textContent = "p = " + sign(Number(where.value).toFixed(1)) + "°";
    }

    const sign = (words) => words.replace("-", "−").replace(/^−0\.0+$/, (zero) => zero.slice(1));

    let timer = 0;
    let runs = null;
    const players = place.querySelectorAll("[data-step]");
    const words = [...players].map((one) => one.textContent);
    function stop() {
      clearInterval(timer);
      timer = 0;
      players.forEach((one, k) => (one.textContent = words[k]));
    }
    players.forEach((player) =>
      player.addEventListener("click", () => {
        const again = timer && runs === player;
        stop();
        if (again) return;
        runs = player;
        player.textContent = "Stop";
        timer = setInterval(() => {
          turn.value = (Number(turn.value) + Number(player.dataset.step)) % 360;
          set();
        }, 60);
      })
    );
    const factors = place.querySelectorAll("[data-factor]");
    factors.forEach((button) =>
      button.addEventListener("click", () => {
        factor = Number(button.dataset.factor);
        factors.forEach((one) => one.setAttribute("aria-pressed", String(one === button)));
        set();
      })
    );
    for (const input of [turn, where]) input.addEventListener("input", set);
    turn.value = 0;
    set();
  }

  // One variant at a time; without this script, and in print, all of them.
  function tab(group) {
    const panes = [...group.children];
    const bar = document.createElement("div");
    bar.className = "tabs";
    bar.setAttribute("role", "group");
    bar.setAttribute("aria-label", "Variant");
    const buttons = panes.map((pane) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = pane.dataset.pane;
      button.addEventListener("click", () => open(pane));
      return button;
    });
    function open(wanted) {
      panes.forEach((pane, k) => {
        pane.hidden = pane !== wanted;
        buttons[k].setAttribute("aria-pressed", String(pane === wanted));
      });
    }
    bar.append(...buttons);
    group.prepend(bar);
    group.classList.add("tabbed");
    open(panes[0]);
  }

  // Marks in the contents where the reader is: the last section that began above a third of the window.
  function follow() {
    const links = [...document.querySelectorAll("nav a")];
    const parts = links.map((link) => document.getElementById(link.hash.slice(1)));
    function mark() {
      const passed = parts.filter((part) => part && part.getBoundingClientRect().top < innerHeight / 3);
      const at = Math.max(passed.length - 1, 0);
      links.forEach((link, k) => {
        if (k !== at) link.removeAttribute("aria-current");
        else if (!link.hasAttribute("aria-current")) {
          link.setAttribute("aria-current", "true");
          const nav = link.parentNode;
          nav.scrollLeft = link.offsetLeft - nav.clientWidth / 2;
        }
      });
    }
    addEventListener("scroll", () => requestAnimationFrame(mark), { passive: true });
    mark();
  }

  function unfold() {
    const part = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const details = part && part.querySelector(":scope > details");
    if (details) details.open = true;
  }

  const visible = (place) => place.offsetParent !== null && (!place.checkVisibility || place.checkVisibility());
  const places = [...document.querySelectorAll(".plot")];
  document.querySelectorAll(".variants").forEach(tab);
  document.querySelectorAll(".mesh").forEach(animate);
  document.querySelectorAll(".drive").forEach(drive);
  document.querySelectorAll("[data-plays]").forEach((button) => {
    const player = document.getElementById(button.dataset.plays).closest(".mesh, .drive").querySelector(".slider button");
    button.addEventListener("click", () => {
      player.click();
      button.textContent = player.textContent;
    });
  });
  follow();
  unfold();
  addEventListener("hashchange", unfold);
  document.querySelectorAll("[data-curve]").forEach((box) =>
    box.addEventListener("change", () => show(box.dataset.curve, box.checked))
  );
  try {
    await unpack("plotly");
  } catch (error) {
    for (const place of places) place.textContent = "This browser is too old to draw this figure.";
    return;
  }
  document.querySelectorAll("[data-menu]").forEach((menu) => {
    menu.addEventListener("input", () => choose(menu));
    if (menu.tagName === "INPUT") menu.value = menu.defaultValue || "0";
    else for (const one of menu.options) one.selected = one.defaultSelected;
  });
  const watch = new IntersectionObserver(
    (entries) => entries.filter((entry) => entry.isIntersecting).forEach((entry) => draw(entry.target)),
    { rootMargin: "600px" }
  );
  places.forEach((place) => watch.observe(place));
  // The rest follows while nobody waits for it, so that a printed page is complete.
  const later = places.filter(visible);
  (function next() {
    const place = later.shift();
    if (place) draw(place).then(() => setTimeout(next, 30));
    else seen.drawn = "all";
  })();
  window.addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((one) => (one.open = true));
    document.querySelectorAll(".pane").forEach((one) => (one.hidden = false));
    places.forEach((place) => draw(place).then(() => Plotly.relayout(place, { width: 340, height: 230 })));
  });
  window.addEventListener("afterprint", () => {
    document.querySelectorAll('.tabs button[aria-pressed="true"]').forEach((one) => one.click());
    places.forEach((place) => Plotly.relayout(place, { width: null, height: null, autosize: true }));
  });
})();
