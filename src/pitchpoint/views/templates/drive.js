  // A drive whose teeth are carried by a wave: every tooth is placed on the deformed neutral line.
  function drivePicture(place) {
    const it = JSON.parse(place.dataset.motion);
    const [z1, z2] = it.teeth;
    const whole = place.querySelector(".whole");
    const close = place.querySelector(".close");
    const deg = 180 / Math.PI;

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
    let arcs = it.arcs;
    const carries = (p) => arcs.some(([low, high]) => near(p) >= low && near(p) <= high);

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

    // Angle of the wave generator and place of the close-up from the long axis, both in degrees.
    function set(angle, { middle = 0, factor = 1, carrying = it.arcs } = {}) {
      arcs = carrying;
      const rates = it.rates.map((rate) => (rate * angle) / deg);
      const place = middle / deg;
      paint(scenes[0], rates, factor, 0, 0, Math.PI);
      paint(scenes[1], rates, 1, rates[0] + place, place, (it.width * 2 * Math.PI) / z1);
      frame.setAttribute("transform", `rotate(${-(rates[0] + place) * deg})`);
      return it.members.map((one, k) => one + " " + signed((rates[k] * deg).toFixed(2)) + "°").join(", ");
    }

    return { set, onward: (angle, by = 0.5) => (((angle + by) % 360) + 360) % 360, direction: 1 };
  }

  const signed = (words) => words.replace("-", "\u2212").replace(/^\u22120\.0+$/, (zero) => zero.slice(1));
