"use strict";
(async function () {
{% include "figures.js" %}

  const place = (id) => document.getElementById(id);
  const seen = document.documentElement.dataset;
  let page;
  try {
    page = JSON.parse(await opened("content"));
  } catch (error) {
    place("brushed").append("This browser is too old to draw the designs of this page.");
    return;
  }
  for (const part of document.querySelectorAll(".scripted")) part.hidden = false;
  const columns = new Map(page.columns.map((column) => [column.name, column]));
  const designs = [...page.labels.keys()];
  const limits = new Map();
  const select = { colour: place("colour"), x: place("x"), y: place("y"), law: place("law"), effect: place("effect") };
  const boxes = [...document.querySelectorAll("#axes input")];
  let shown = designs;  // designs within all limits
  let one = -1;  // the design that is opened

  const law = () => Number(select.law ? select.law.value : 0);
  const valuesOf = (name) => {
    const { values } = columns.get(name);
    return values[values.length > 1 ? law() : 0];
  };
  const axes = () => boxes.filter((box) => box.checked).map((box) => box.value);
  const better = (axis) => place(`${axis}-better`).value;
  const brief = (value, digits = 5) => (value === null ? "–" : minus(Number(value.toPrecision(digits))));
  const written = (column, value, digits) => (column.levels.length && value !== null ? column.levels[Math.max(0, Math.min(value, column.levels.length - 1))] : brief(value, digits));
  const titled = ({ words, unit }) => (unit ? `${words} [${unit}]` : words);
  const breaking = (column) => titled(column).replace(/[._]/g, "$&\u200b");
  const colourOf = (name) => getComputedStyle(document.body).getPropertyValue(name).trim();

  function range(name) {
    const { levels } = columns.get(name);
    if (levels.length > 1) return [0, levels.length - 1];
    const finite = valuesOf(name).filter((value) => value !== null);
    const [low, high] = finite.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
    if (low < high) return [low, high];
    return low === high ? [low - (Math.abs(low) || 1), high + (Math.abs(high) || 1)] : [0, 1];
  }

  // Scale of an axis. Results that crowd at one end of a range of powers of ten go by their logarithm.
  function scale(name, beyond = 0) {
    const { levels, input } = columns.get(name);
    const [low, high] = range(name);
    const finite = levels.length || input ? [] : valuesOf(name).filter((value) => value !== null).sort((a, b) => a - b);
    const log = low > 0 && high > 20 * low && finite.length > 0 && finite[finite.length >> 1] < low + 0.15 * (high - low);
    const [bent, back] = log ? [Math.log10, (v) => 10 ** v] : [(v) => v, (v) => v];
    const [from, to] = [bent(low) - beyond * (bent(high) - bent(low)), bent(high) + beyond * (bent(high) - bent(low))];
    return {
      span: [low, high],
      share: (value) => (bent(value) - from) / (to - from),
      value: (share) => back(from + share * (to - from)),
      ticks: (most) => (log ? powers([back(from), back(to)]) : ticks([from, to], most)),
    };
  }

  function powers([low, high]) {
    const places = [];
    for (let power = Math.floor(Math.log10(low)); 10 ** power <= high; power++) {
      places.push(...[1, 2, 5].map((factor) => Number((factor * 10 ** power).toPrecision(2))));
    }
    return places.filter((place) => place >= low && place <= high);
  }

  // Places of round numbers within a range.
  function ticks([low, high], most) {
    const rough = (high - low) / most;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
    const places = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) places.push(Number((k * step).toPrecision(12)));
    return places;
  }

  // Colours that rise in lightness, fit for colour vision deficiency; on dark paper without the darkest.
  const STOPS = dark.matches
    ? [[140, 122, 230], [80, 150, 220], [47, 180, 160], [110, 205, 90], [216, 226, 60]]
    : [[68, 1, 84], [59, 82, 139], [33, 130, 140], [60, 170, 100], [170, 200, 30]];
  function shade(share) {
    const at = Math.min(Math.max(share, 0), 1) * (STOPS.length - 1);
    const k = Math.min(Math.floor(at), STOPS.length - 2);
    const mixed = STOPS[k].map((part, n) => Math.round(part + (at - k) * (STOPS[k + 1][n] - part)));
    return `rgb(${mixed.join(",")})`;
  }
  function shades() {
    const values = valuesOf(select.colour.value);
    const { share } = scale(select.colour.value);
    const none = colourOf("--soft");
    return designs.map((k) => (values[k] === null ? none : shade(share(values[k]))));
  }

  const tag = (name, given, words) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(given)) made.setAttribute(key, value);
    if (words !== undefined) made.textContent = words;
    return made;
  };
  function sized(canvas, width, height) {
    const scale = window.devicePixelRatio || 1;
    canvas.width = width * scale;
    canvas.height = height * scale;
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    return pen;
  }

  // Parallel coordinates.
  const HIGH = 320;
  const [TOP, BOTTOM] = [12, 10];
  const parallel = place("parallel");
  const canvas = parallel.querySelector("canvas");
  const lines = parallel.querySelector("svg");
  const heads = place("heads");
  let across = [];  // places of the axes
  let ground = null;  // all lines in grey, as they are behind those that are selected

  const up = (value, { share }) => TOP + (1 - share(value)) * (HIGH - TOP - BOTTOM);
  const down = (y, { value }) => value(1 - (y - TOP) / (HIGH - TOP - BOTTOM));

  function layAxes() {
    const names = axes();
    const least = 92;
    const width = Math.max(parallel.parentNode.clientWidth, least * names.length);
    const room = width / Math.max(names.length, 1);
    across = names.map((_, k) => room * (k + 0.5));
    parallel.style.width = `${width}px`;
    heads.replaceChildren(...names.map((name, k) => {
      const head = document.createElement("span");
      head.textContent = breaking(columns.get(name));
      head.style.left = `${across[k] - room / 2 + 3}px`;
      head.style.width = `${room - 6}px`;
      return head;
    }));
    const head = Math.max(0, ...[...heads.children].map((child) => child.offsetHeight));
    heads.style.height = `${head + 6}px`;
    parallel.style.height = `${head + 6 + HIGH}px`;
    ground = document.createElement("canvas");
    const pen = sized(ground, width, HIGH);
    const grey = colourOf("--edge");
    trace(pen, designs, () => grey, 0.5, Math.min(1, 0.15 + 150 / designs.length));
    sized(canvas, width, HIGH);
    lines.setAttribute("width", width);
    lines.setAttribute("height", HIGH);
    layLimits(names);
  }

  function trace(pen, which, colour, width, alpha) {
    const names = axes();
    const drawn = names.map((name) => {
      const along = scale(name);
      return valuesOf(name).map((value) => (value === null ? null : up(value, along)));
    });
    pen.lineWidth = width;
    pen.globalAlpha = alpha;
    for (const k of which) {
      pen.strokeStyle = colour(k);
      pen.beginPath();
      let on = false;
      names.forEach((_, axis) => {
        const y = drawn[axis][k];
        if (y === null) on = false;
        else if (on) pen.lineTo(across[axis], y);
        else pen.moveTo(across[axis], y);
        on = y !== null;
      });
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  function drawParallel(colours) {
    const width = parseFloat(canvas.style.width);
    const pen = canvas.getContext("2d");
    pen.clearRect(0, 0, width, HIGH);
    pen.drawImage(ground, 0, 0, width, HIGH);
    trace(pen, shown, (k) => colours[k], 1.1, Math.min(1, 0.3 + 120 / Math.max(shown.length, 1)));
    if (one >= 0) trace(pen, [one], () => colourOf("--mark"), 3, 1);
    lines.replaceChildren(...axes().flatMap((name, k) => axis(name, across[k])));
  }

  function axis(name, x) {
    const { levels } = columns.get(name);
    const along = scale(name);
    const { span } = along;
    const parts = [tag("line", { class: "line", x1: x, x2: x, y1: TOP, y2: HIGH - BOTTOM })];
    const limit = limits.get(name);
    if (limit) {
      const [low, high] = limit.map((end, k) => up(Math.min(Math.max(end === null ? span[k] : end, span[0]), span[1]), along));
      parts.push(tag("rect", { class: "limit", x: x - 8, width: 16, y: high - 2, height: low - high + 4 }));
    }
    for (const value of levels.length ? levels.keys() : along.ticks(6)) {
      const y = up(value, along);
      parts.push(tag("line", { class: "line", x1: x - 3, x2: x + 3, y1: y, y2: y }));
      parts.push(tag("text", { x: x + 6, y: y + 4 }, levels.length ? levels[value] : brief(value)));
    }
    const hit = tag("rect", { class: "hit", x: x - 18, width: 36, y: 0, height: HIGH, "data-axis": name });
    return [...parts, hit];
  }

  // Ends of a limit have so many digits that they stand in their boxes whole.
  function round(value, [low, high]) {
    const step = 10 ** (Math.floor(Math.log10(Math.min(high - low, Math.abs(value) || high - low))) - 3);
    return Number((Math.round(value / step) * step).toPrecision(12));
  }

  let drag = null;
  lines.addEventListener("pointerdown", (event) => {
    const name = event.target.dataset.axis;
    if (name === undefined) return;
    drag = { name, from: event.clientY, top: lines.getBoundingClientRect().top };
    lines.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  lines.addEventListener("pointermove", (event) => {
    if (!drag || Math.abs(event.clientY - drag.from) < 4) return;
    const along = scale(drag.name);
    const { span } = along;
    const exact = columns.get(drag.name).levels.length > 0;
    const ends = [drag.from, event.clientY].map((y) => down(y - drag.top, along));
    const [low, high] = [Math.min(...ends), Math.max(...ends)];
    limits.set(drag.name, exact ? [Math.ceil(low), Math.floor(high)] : [round(Math.max(low, span[0]), span), round(Math.min(high, span[1]), span)]);
    // Beyond an end of the axis there is no limit.
    const limit = limits.get(drag.name);
    if (low <= span[0]) limit[0] = null;
    if (high >= span[1]) limit[1] = null;
    drag.moved = true;
    later();
  });
  lines.addEventListener("pointerup", (event) => {
    if (drag && !drag.moved && Math.abs(event.clientY - drag.from) < 4) limits.delete(drag.name);
    drag = null;
    later();
  });

  // Limits as numbers.
  function layLimits(names) {
    for (const name of limits.keys()) if (!names.includes(name)) limits.delete(name);
    place("limits").replaceChildren(...names.map((name) => {
      const column = columns.get(name);
      const row = document.createElement("div");
      const words = document.createElement("span");
      words.textContent = breaking(column);
      row.append(words);
      if (column.levels.length) {
        const menu = document.createElement("select");
        menu.dataset.limit = name;
        menu.setAttribute("aria-label", `${column.words}, which`);
        menu.append(new Option("any", ""), ...column.levels.map((level, k) => new Option(level, k)), new Option("several", "several"));
        menu.lastChild.hidden = true;
        menu.addEventListener("change", () => {
          if (menu.value === "") limits.delete(name);
          else limits.set(name, [Number(menu.value), Number(menu.value)]);
          later();
        });
        row.append(menu);
      } else {
        for (const [end, said] of [[0, "least"], [1, "largest"]]) {
          const box = document.createElement("input");
          Object.assign(box, { type: "number", step: "any", placeholder: said });
          box.dataset.limit = name;
          box.dataset.end = end;
          box.setAttribute("aria-label", `${titled(column)}, ${said}`);
          box.addEventListener("input", () => {
            const limit = limits.get(name) || [null, null];
            limit[end] = box.value === "" ? null : Number(box.value);
            limits.set(name, limit);
            later();
          });
          row.append(box);
        }
      }
      return row;
    }));
  }

  function tellLimits() {
    for (const box of document.querySelectorAll("[data-limit]")) {
      if (box === document.activeElement && box.nodeName === "INPUT" && limits.has(box.dataset.limit)) continue;
      const limit = limits.get(box.dataset.limit);
      if (box.nodeName === "SELECT") box.value = !limit ? "" : limit[0] === limit[1] && limit[0] !== null ? limit[0] : "several";
      else box.value = limit && limit[box.dataset.end] !== null ? limit[box.dataset.end] : "";
    }
  }

  function within(k) {
    for (const [name, [low, high]] of limits) {
      const value = valuesOf(name)[k];
      if (value === null || (low !== null && value < low) || (high !== null && value > high)) return false;
    }
    return true;
  }

  // Tables.
  function opener(k) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = page.labels[k];
    button.addEventListener("click", () => open(k));
    const cell = document.createElement("th");
    cell.scope = "row";
    cell.append(button);
    return cell;
  }
  function fill(table, caption, names, which) {
    const head = document.createElement("tr");
    for (const name of [null, ...names]) {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.className = name && !columns.get(name).levels.length ? "n" : "";
      cell.textContent = name ? breaking(columns.get(name)) : "design";
      head.append(cell);
    }
    const rows = which.map((k) => {
      const row = document.createElement("tr");
      row.append(opener(k), ...names.map((name) => {
        const cell = document.createElement("td");
        cell.className = columns.get(name).levels.length ? "" : "n";
        cell.textContent = written(columns.get(name), valuesOf(name)[k]);
        return cell;
      }));
      return row;
    });
    table.caption.textContent = caption;
    table.tHead.replaceChildren(head);
    table.tBodies[0].replaceChildren(...rows);
  }
  const ROWS = 12;
  function tellSelected() {
    const { words, better: sense, name } = columns.get(select.colour.value);
    const values = valuesOf(name);
    const turn = sense === "more" ? -1 : 1;
    const order = [...shown].sort((a, b) => (values[a] === null) - (values[b] === null) || turn * (values[a] - values[b]) || a - b);
    place("count").textContent = `${shown.length} of ${designs.length} designs selected`;
    const by = shown.length === 0 ? "No design lies within all limits" : `${shown.length > ROWS ? `${ROWS} of ${shown.length} selected designs, ` : "Selected designs, "}${sense ? "the best" : "the least"} by ${words} first`;
    const beside = page.columns.filter((column) => column.input && !column.axis).map((column) => column.name);
    fill(place("selected"), by, [...axes(), ...beside], order.slice(0, ROWS));
  }

  // Two results against each other.
  const scatter = place("scatter");
  const points = scatter.querySelector("canvas");
  const frame = scatter.querySelector("svg");
  const tip = place("tip");
  const TALL = 380;
  const EDGE = { left: 70, right: 16, top: 12, bottom: 48 };
  let spread = [];  // places of the points, null where one has no value

  function frontOf(which) {
    const [x, y] = [valuesOf(select.x.value), valuesOf(select.y.value)];
    const [turnX, turnY] = ["x", "y"].map((axis) => ({ less: 1, more: -1, "": 0 })[better(axis)]);
    if (!turnX || !turnY) return [];
    const order = which.filter((k) => x[k] !== null && y[k] !== null).sort((a, b) => turnX * (x[a] - x[b]) || turnY * (y[a] - y[b]) || a - b);
    let best = Infinity;
    return order.filter((k) => turnY * y[k] < best && ((best = turnY * y[k]), true));
  }

  function drawScatter(colours) {
    const width = scatter.clientWidth;
    scatter.style.height = `${TALL}px`;
    const pen = sized(points, width, TALL);
    frame.setAttribute("width", width);
    frame.setAttribute("height", TALL);
    const [alongX, alongY] = [scale(select.x.value, 0.03), scale(select.y.value, 0.03)];
    const toX = (v) => EDGE.left + alongX.share(v) * (width - EDGE.left - EDGE.right);
    const toY = (v) => TALL - EDGE.bottom - alongY.share(v) * (TALL - EDGE.top - EDGE.bottom);
    const [x, y] = [valuesOf(select.x.value), valuesOf(select.y.value)];
    spread = designs.map((k) => (x[k] === null || y[k] === null ? null : [toX(x[k]), toY(y[k])]));
    const dot = (k, size, colour) => {
      if (!spread[k]) return;
      pen.fillStyle = colour;
      pen.beginPath();
      pen.arc(...spread[k], size, 0, 7);
      pen.fill();
    };
    pen.globalAlpha = 0.6;
    for (const k of designs) dot(k, 2, colourOf("--edge"));
    pen.globalAlpha = 0.85;
    for (const k of shown) dot(k, 3, colours[k]);
    pen.globalAlpha = 1;
    const front = frontOf(place("among").checked ? shown : designs);
    pen.strokeStyle = pen.fillStyle = colourOf("--mark");
    pen.lineWidth = 1.5;
    pen.beginPath();
    front.forEach((k, n) => {
      if (n) pen.lineTo(spread[k][0], spread[front[n - 1]][1]);
      pen.lineTo(...spread[k]);
    });
    pen.stroke();
    for (const k of front) {
      pen.beginPath();
      pen.arc(...spread[k], 4.5, 0, 7);
      pen.stroke();
    }
    if (one >= 0) dot(one, 7, colourOf("--mark"));
    const [right, bottom] = [width - EDGE.right, TALL - EDGE.bottom];
    const [named, over] = [columns.get(select.x.value), columns.get(select.y.value)];
    frame.replaceChildren(
      tag("path", { class: "line", d: `M${EDGE.left} ${EDGE.top}V${bottom}H${right}` }),
      ...alongX.ticks(width / 110).flatMap((v) => [tag("line", { class: "line", x1: toX(v), x2: toX(v), y1: bottom, y2: bottom + 4 }), tag("text", { x: toX(v), y: bottom + 16, "text-anchor": "middle" }, brief(v))]),
      ...alongY.ticks(6).flatMap((v) => [tag("line", { class: "line", x1: EDGE.left - 4, x2: EDGE.left, y1: toY(v), y2: toY(v) }), tag("text", { x: EDGE.left - 7, y: toY(v) + 4, "text-anchor": "end" }, brief(v))]),
      tag("text", { x: (EDGE.left + right) / 2, y: TALL - 10, "text-anchor": "middle" }, titled(named)),
      tag("text", { x: 0, y: 0, "text-anchor": "middle", transform: `translate(14 ${(EDGE.top + bottom) / 2}) rotate(-90)` }, titled(over)),
      tag("rect", { x: 0, y: 0, width, height: TALL, fill: "transparent" })
    );
    tellFront(front);
  }

  function tellFront(front) {
    const table = document.querySelector("#front-table table");
    if (!table) return;
    const step = Math.max(1, Math.ceil(front.length / ROWS));
    const few = front.filter((_, n) => n % step === 0 || n === front.length - 1);
    const inputs = page.columns.filter((column) => column.input).map((column) => column.name);
    const names = [...new Set([select.x.value, select.y.value, ...inputs])];
    const among = place("among").checked ? "the selected designs" : "all designs";
    const caption = better("x") && better("y")
      ? `${few.length < front.length ? `${few.length} of ` : ""}${front.length} designs on the front of ${among}`
      : "No front: say what is better on both axes";
    fill(table, caption, names, few);
  }

  function nearest(event) {
    const { left, top } = points.getBoundingClientRect();
    const [x, y] = [event.clientX - left, event.clientY - top];
    const far = (k) => (spread[k] ? Math.hypot(spread[k][0] - x, spread[k][1] - y) : Infinity);
    const near = (which) => which.reduce((best, k) => (far(k) < far(best) ? k : best), which[0]);
    const found = shown.length ? near(shown) : -1;
    return found >= 0 && far(found) < 14 ? found : -1;
  }
  let corner = null;
  frame.addEventListener("pointermove", (event) => {
    if (corner) {
      const { left, top } = points.getBoundingClientRect();
      const [x, y] = [event.clientX - left, event.clientY - top];
      frame.querySelector(".rectangle")?.remove();
      if (Math.hypot(x - corner[0], y - corner[1]) < 5) return;
      frame.append(tag("rect", { class: "rectangle", x: Math.min(x, corner[0]), y: Math.min(y, corner[1]), width: Math.abs(x - corner[0]), height: Math.abs(y - corner[1]) }));
      return;
    }
    const k = nearest(event);
    tip.hidden = k < 0;
    if (k < 0) return;
    const names = [...new Set([...page.columns.filter((column) => column.input).map((column) => column.name), select.x.value, select.y.value])];
    tip.replaceChildren(...[`design ${page.labels[k]}`, ...names.map((name) => `${columns.get(name).words}: ${written(columns.get(name), valuesOf(name)[k])} ${columns.get(name).unit}`)].map((words) => {
      const line = document.createElement("div");
      line.textContent = words;
      return line;
    }));
    const [x, y] = spread[k];
    tip.style.left = `${Math.max(0, Math.min(x + 12, scatter.clientWidth - tip.offsetWidth))}px`;
    tip.style.top = `${Math.max(0, y - tip.offsetHeight - 10)}px`;
  });
  frame.addEventListener("pointerleave", () => (tip.hidden = true));
  frame.addEventListener("pointerdown", (event) => {
    const { left, top } = points.getBoundingClientRect();
    if (event.pointerType === "touch") return;
    corner = [event.clientX - left, event.clientY - top];
    frame.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  frame.addEventListener("pointerup", (event) => {
    const drawn = frame.querySelector(".rectangle");
    const from = corner;
    corner = null;
    if (!drawn || !from) {
      const k = nearest(event);
      return k >= 0 ? open(k, true) : undefined;
    }
    const { left, top } = points.getBoundingClientRect();
    const valueX = (x) => scale(select.x.value, 0.03).value((x - EDGE.left) / (scatter.clientWidth - EDGE.left - EDGE.right));
    const valueY = (y) => scale(select.y.value, 0.03).value((TALL - EDGE.bottom - y) / (TALL - EDGE.top - EDGE.bottom));
    const ends = [[from[0], event.clientX - left].map(valueX), [from[1], event.clientY - top].map(valueY)];
    [select.x.value, select.y.value].forEach((name, k) => {
      const span = range(name);
      limits.set(name, [Math.min(...ends[k]), Math.max(...ends[k])].map((end) => round(end, span)));
      for (const box of boxes) if (box.value === name) box.checked = true;
    });
    relaid();
  });

  // One design, and what opens it.
  const quoted = (text) => (/^[\w .,+\-/%°=]*$/.test(text) ? `"${text}"` : `'${text.replace(/'/g, "'\\''")}'`);
  function valueOf(column, k) {
    const value = column.values[0][k];
    if (column.levels.length) return column.levels[value];
    return column.written && column.written !== "1" ? `${value} ${column.written}` : String(value);
  }
  function command(k) {
    const { command, call, files } = page.opening;
    const inputs = page.columns.filter((column) => column.input);
    if (files) return files[page.labels[k]] ? files[page.labels[k]].command : "";
    if (command) return [command, ...inputs.map((column) => `--set ${quoted(`${column.name}=${valueOf(column, k)}`)}`)].join(" ");
    const plain = (column) => (column.levels.length || (column.written && column.written !== "1") ? JSON.stringify(valueOf(column, k)) : valueOf(column, k));
    return call ? `${call}({${inputs.map((column) => `${JSON.stringify(column.name)}: ${plain(column)}`).join(", ")}})` : "";
  }
  function open(k, stays = false) {
    one = k;
    place("design-name").replaceChildren(`Design ${page.labels[k]}`);
    const file = page.opening.files && page.opening.files[page.labels[k]];
    if (file) {
      const link = document.createElement("a");
      link.href = file.link;
      link.textContent = file.link;
      place("design-name").append(", its case file ", link);
    } else if (page.opening.files) place("design-name").append(page.opening.without);
    place("command").textContent = command(k);
    place("design-opens").hidden = !command(k);
    const [few, others] = [true, false].map((main) => page.columns.filter((column) => main === (column.input || column.better !== "" || !page.columns.some((any) => any.better))).map((column) => {
      const row = document.createElement("tr");
      const [head, cell] = [document.createElement("th"), document.createElement("td")];
      head.scope = "row";
      head.textContent = breaking(column);
      cell.className = column.levels.length ? "" : "n";
      cell.textContent = written(column, valuesOf(column.name)[k], column.input ? 6 : 5);
      row.append(head, cell);
      return row;
    }));
    place("design").tBodies[0].replaceChildren(...few);
    place("design-others").tBodies[0].replaceChildren(...others);
    place("design-others").closest("details").hidden = !others.length;
    if (!stays) place("chosen").scrollIntoView();
    later();
  }
  place("copy").addEventListener("click", async () => {
    getSelection().selectAllChildren(place("command"));
    try {
      await navigator.clipboard.writeText(place("command").textContent);
      place("copy").textContent = "Copied";
    } catch (error) {
      place("copy").textContent = "Selected";
    }
    setTimeout(() => (place("copy").textContent = "Copy"), 2000);
  });

  // Results over each input.
  function drawEffects() {
    if (!select.effect) return;
    const name = select.effect.value;
    const effects = page.effects[page.effects.length > 1 ? law() : 0][name] || {};
    const every = Object.values(effects).flat();
    const [low, high] = [Math.min(...every.map((row) => row[2])), Math.max(...every.map((row) => row[3]))];
    const span = high > low ? high - low : 1;
    place("effects").replaceChildren(...Object.entries(effects).map(([key, rows]) => {
      const column = columns.get(key);
      const places = rows.map((row) => row[0]);
      const [first, last] = [Math.min(...places), Math.max(...places)];
      const x = (v) => 52 + (last > first ? (v - first) / (last - first) : 0.5) * 258;
      const y = (v) => 130 - ((v - low) / span) * 118;
      const drawing = tag("svg", { class: "effect", viewBox: "0 0 330 170", role: "img", "aria-label": `${titled(columns.get(name))} over ${titled(column)}` });
      const along = (end) => rows.map((row) => `${x(row[0])} ${y(row[end])}`);
      drawing.append(
        tag("path", { class: "band", d: `M${along(2).join("L")}L${along(3).reverse().join("L")}Z` }),
        tag("path", { class: "median", d: `M${along(1).join("L")}` }),
        tag("path", { class: "frame", d: "M52 12V130H310" }),
        ...ticks([low, high > low ? high : low + 1], 4).map((v) => tag("text", { x: 47, y: y(v) + 4, "text-anchor": "end" }, brief(v))),
        ...(column.levels.length ? places : ticks([first, last > first ? last : first + 1], 4)).map((v) => tag("text", { x: x(v), y: 146, "text-anchor": "middle" }, column.levels.length ? column.levels[v] : brief(v))),
        tag("text", { x: 181, y: 163, "text-anchor": "middle" }, titled(column))
      );
      return drawing;
    }));
  }

  function tellScale() {
    const column = columns.get(select.colour.value);
    const [low, high] = range(column.name);
    const bar = document.createElement("i");
    bar.style.background = `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map(shade).join(", ")})`;
    place("scale").replaceChildren(`${titled(column)}: ${written(column, low)}`, bar, written(column, high));
  }

  let waiting = false;
  function later() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(redraw);
  }
  function redraw() {
    waiting = false;
    for (const [name, limit] of limits) if (limit[0] === null && limit[1] === null) limits.delete(name);
    shown = limits.size ? designs.filter(within) : designs;
    const colours = shades();
    drawParallel(colours);
    drawScatter(colours);
    tellLimits();
    tellSelected();
    tellScale();
    seen.drawn = "all";
  }
  function relaid() {
    layAxes();
    redraw();
  }

  for (const axis of ["x", "y"]) {
    const proper = () => (place(`${axis}-better`).value = columns.get(select[axis].value).better);
    select[axis].addEventListener("change", () => { proper(); later(); });
    place(`${axis}-better`).addEventListener("change", later);
    proper();
  }
  place("among").addEventListener("change", later);
  select.colour.addEventListener("change", later);
  if (select.law) select.law.addEventListener("change", () => { relaid(); drawEffects(); if (one >= 0) open(one, true); });
  if (select.effect) select.effect.addEventListener("change", drawEffects);
  for (const box of boxes) box.addEventListener("change", relaid);
  const clear = () => { limits.clear(); if (document.activeElement?.dataset.limit) document.activeElement.blur(); later(); };
  place("clear").addEventListener("click", clear);
  addEventListener("keydown", (event) => { if (event.key === "Escape") clear(); });
  let width = 0;
  new ResizeObserver(() => {
    const now = scatter.parentNode.clientWidth;
    if (now !== width) relaid();
    width = now;
  }).observe(scatter.parentNode);
  width = scatter.parentNode.clientWidth;
  relaid();
  drawEffects();
  open(page.opening.at || 0, true);
})();
