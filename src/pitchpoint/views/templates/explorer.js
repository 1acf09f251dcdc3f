"use strict";
(async function () {
{% include "figures.js" %}

{% include "mesh.js" %}

{% include "drive.js" %}

  const seen = document.documentElement.dataset;
  const named = (id) => document.getElementById(id);
  const text = (id, words) => (named(id).textContent = words);

  let it;
  try {
    it = JSON.parse(await opened("explored"), dressed);
    await unpack("plotly");
  } catch (error) {
    text("impossible", "This browser is too old for this page.");
    named("impossible").hidden = false;
    return;
  }
  const sliders = it.axes.map((_, k) => named("slider-" + k));
  const menu = named("law");
  const law = () => (menu ? Number(menu.value) : 0);

  // Points of the grid are numbered with the last input running fastest.
  const strides = it.axes.map((_, k) => it.axes.slice(k + 1).reduce((count, one) => count * one.values.length, 1));
  const values = (number) => it.axes.map((one, k) => one.values[Math.floor(number / strides[k]) % one.values.length]);

  // Where the sliders stand; within half a step of a computed value, which they may not meet, at that value.
  function stands() {
    return it.axes.map((axis, k) => {
      const place = Number(sliders[k].value);
      const next = axis.values.reduce((best, one) => (Math.abs(one - place) < Math.abs(best - place) ? one : best));
      return axis.whole || Math.abs(next - place) <= 0.5001 * axis.step ? next : place;
    });
  }

  // Computed points around a place with their weights, which are linear along every input.
  function around(place, nearest) {
    let found = [[0, 1]];
    it.axes.forEach((axis, k) => {
      let low = 0;
      while (low < axis.values.length - 2 && axis.values[low + 1] <= place[k]) low += 1;
      const between = (place[k] - axis.values[low]) / (axis.values[low + 1] - axis.values[low]);
      const share = nearest(axis) ? Math.round(between) : between;
      const parts = [[low, 1 - share], [low + 1, share]].filter((one) => one[1] > 1e-9);
      found = found.flatMap(([number, weight]) => parts.map(([at, part]) => [number + at * strides[k], weight * part]));
    });
    return found;
  }
  const linear = (place) => around(place, () => false);
  const nearest = (place) => around(place, () => true)[0][0];

  // Value of a figure between points; none where one of them has none.
  function valued(rows, points) {
    let sum = 0;
    for (const [number, weight] of points) {
      if (rows[number] === null) return null;
      sum += weight * rows[number];
    }
    return sum;
  }

  // Numbers as `number` of the report writes them.
  function digits(value) {
    const [mantissa, power] = value.toExponential(3).split("e").map(Number);
    if (power < -3 || power >= 6) return minus(mantissa + "e" + power);
    if (Math.abs(value - Math.round(value)) <= 1e-9 * Math.abs(value)) return minus(Math.round(value));
    return minus(Number(mantissa + "e" + power));
  }

  function told(value, figure) {
    if (value === null) return figure.unit === "%" ? "undefined, no power" : "undefined";
    return (digits(Math.abs(value) < 1e-9 ? 0 : value) + " " + figure.unit).trim();
  }
  const placed = (value, axis) => (digits(value) + " " + axis.unit).trim();
  const where = (place) => it.axes.map((axis, k) => axis.words + " = " + placed(place[k], axis)).join("; ");

  // Why there are no figures: the sentence of the point that counts most of those that are not possible.
  function refusal(place, points) {
    const bad = points.filter(([number]) => it.why[law()][number]).sort((a, b) => b[1] - a[1]);
    if (!bad.length) return "";
    const sentence = it.sentences[it.why[law()][bad[0][0]]];
    if (points.length === 1) return "Not possible: " + sentence + ".";
    return "Not possible at " + where(values(bad[0][0])) + ", next to where the sliders stand: " + sentence + ".";
  }

  const movers = { mesh: meshPicture, drive: drivePicture };
  const drawings = [...document.querySelectorAll(".moving")];
  const pictures = drawings.map((one) => movers[one.dataset.kind](one));
  const phase = named("phase");
  let shown = it.drawing.find((one) => one.length) || [];
  let pace = shown.map(() => 1);
  let phases = shown.map(() => 0);

  // Stages turn together: of each the phase of its own mesh cycle.
  function move() {
    if (!pictures.length) return;
    const acting = it.acting[nearest(stands())];
    const told = shown.map((one, k) => {
      const words = pictures[one].set(phases[k], acting[k] ? { carrying: acting[k] } : {});
      const title = shown.length > 1 ? drawings[one].querySelector("h3").textContent + ", " : "";
      return title + words;
    });
    text("place", told.join("; "));
  }

  function onward(by) {
    phases = phases.map((one, k) => pictures[shown[k]].onward(one, by * pace[k]));
  }

  function teeth(place) {
    if (!pictures.length) return;
    const point = nearest(place);
    const drawing = it.drawing[point];
    if (!drawing.length) {
      text("drawn", "Not drawn at this place, where the gears are not possible; these are the last ones that were.");
      return;
    }
    drawings.forEach((one, k) => (one.hidden = !drawing.includes(k)));
    shown = drawing;
    pace = it.pace[point];
    const shaping = it.axes.map((axis, k) => [axis, values(point)[k]]).filter(([axis]) => axis.shapes);
    const at = shaping.map(([axis, value]) => axis.words + " = " + placed(value, axis)).join("; ");
    text("drawn", at ? "Drawn to scale at the nearest computed value: " + at + "." : "Drawn to scale; these inputs leave the teeth as they are.");
    move();
  }

  let timer = 0;
  const player = named("play");
  function play(on) {
    clearInterval(timer);
    timer = on
      ? setInterval(() => {
          onward(Number(phase.step));
          phase.value = phases[0];
          move();
        }, 60)
      : 0;
    player.textContent = on ? "Stop" : "Play";
  }

  function plot(id, data, look) {
    const place = named(id);
    if (!place.dataset.drawn) {
      place.dataset.drawn = "1";
      offer(place);
      if (touch) look.dragmode = false;
    }
    return Plotly.react(place, data, look, config).then(() => tell(place));
  }

  function line(x, y, colour, name, unit) {
    const hovertemplate = "%{y:.4~r} " + unit + "<br>at %{x:.4~r}";
    return { type: "scatter", mode: "lines", x, y, name, hovertemplate, line: { color: colour, width: 2 } };
  }

  // Courses of the nearest teeth, interpolated over inputs that leave teeth and phases as they are.
  function courses(place) {
    if (!it.courses.length) return [];
    const points = around(place, (axis) => axis.shapes);
    const missing = points.find(([number]) => it.courses[0].points[number] === null);
    named("coursed").hidden = Boolean(missing);
    named("uncoursed").hidden = !missing;
    if (missing) {
      const why = it.sentences[it.absent[missing[0]]] || refusal(place, linear(place));
      text("uncoursed", "Not shown here: " + why);
      return [];
    }
    return it.courses.map((course) => {
      const first = course.points[points[0][0]];
      const lines = it.laws.map((one, k) => {
        const rows = points.map(([number, weight]) => [course.points[number][1], weight]);
        const y = first[1][Math.min(k, first[1].length - 1)].map((_, node) => {
          let sum = 0;
          for (const [row, weight] of rows) {
            const value = row[Math.min(k, row.length - 1)][node];
            if (value === null || value === undefined) return null;
            sum += weight * value;
          }
          return sum;
        });
        return line(course.phases[first[0]], y, one.colour, one.title, "");
      });
      const chosen = first[1].length > 1 ? lines : lines.slice(0, 1);
      return plot("course-" + course.name, chosen, course.layout);
    });
  }

  // The figure that is chosen over each input.
  function over(place) {
    const figure = it.figures[Number(named("shown").value)];
    const [low, high] = figure.range;
    const edge = 0.05 * (high - low) || 0.05 * Math.abs(high) || 1;
    return it.axes.map((axis, k) => {
      const along = (x) => linear(place.map((one, n) => (n === k ? x : one)));
      const lines = it.laws.map((one, n) =>
        line(axis.values, axis.values.map((x) => valued(figure.values[n], along(x))), one.colour, one.title, figure.unit)
      );
      const here = [valued(figure.values[law()], linear(place))];
      const dot = { type: "scatter", mode: "markers", x: [place[k]], y: here, name: "where the sliders stand" };
      dot.marker = { size: 11, color: it.laws[law()].colour };
      dot.hovertemplate = lines[0].hovertemplate;
      const look = structuredClone(it.over);
      look.xaxis.title.text = axis.words + (axis.unit ? " [" + axis.unit + "]" : "");
      look.yaxis.title.text = figure.axis;
      look.yaxis.range = [low - edge, high + edge];
      return plot("over-" + k, [...lines, dot], look);
    });
  }

  // What is told of one friction law begins with its name or its title.
  const ofOthers = (sentence) => it.laws.some((one, k) => k !== law() && [one.name, one.title].some((name) => sentence.startsWith(name + ":")));

  function warned(point) {
    const [fails, warns] = it.told[point].map((all) => all.filter((one) => !ofOthers(it.sentences[one])));
    const place = named("told");
    place.replaceChildren();
    for (const [sentences, kind] of [[fails, "fails"], [warns, "warning"]]) {
      for (const one of sentences) {
        const made = document.createElement("p");
        made.className = kind;
        made.textContent = (kind === "warning" ? "Warning. " : "") + it.sentences[one];
        place.append(made);
      }
    }
    if (fails.length + warns.length && linear(stands()).length > 1) {
      const made = document.createElement("p");
      made.className = "note";
      made.textContent = "At the nearest computed point: " + where(values(point)) + ".";
      place.append(made);
    }
  }

  let speaking = 0;
  function speak(place, points, refused) {
    clearTimeout(speaking);
    const main = it.figures.slice(0, 3).map((one) => one.words + " " + told(valued(one.values[law()], points), one));
    speaking = setTimeout(() => text("spoken", where(place) + ": " + (refused || main.join(", ") + ".")), 500);
  }

  function set() {
    const place = stands();
    const points = linear(place);
    it.axes.forEach((axis, k) => {
      text("at-" + k, placed(place[k], axis));
      sliders[k].setAttribute("aria-valuetext", placed(place[k], axis));
    });
    const refused = refusal(place, points);
    text("impossible", refused);
    named("impossible").hidden = !refused;
    named("possible").hidden = Boolean(refused);
    for (const one of document.querySelectorAll("[data-value]")) {
      const figure = it.figures[Number(one.dataset.value)];
      one.textContent = refused ? "not possible" : told(valued(figure.values[law()], points), figure);
    }
    warned(nearest(place));
    teeth(place);
    speak(place, points, refused);
    return Promise.all([...courses(place), ...over(place)]);
  }

  let waits = false;
  function later() {
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => {
      waits = false;
      set();
    });
  }
  const form = named("inputs");
  form.addEventListener("input", later);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(later));
  named("shown").addEventListener("input", later);
  form.reset();
  named("shown").selectedIndex = 0;
  if (pictures.length) {
    phase.value = 0;
    phase.addEventListener("input", () => {
      onward((Number(phase.value) - phases[0]) * pictures[shown[0]].direction);
      phases[0] = Number(phase.value);
      move();
    });
    player.addEventListener("click", () => play(!timer));
  }
  await set();
  if (pictures.length && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  seen.drawn = "all";
})();
