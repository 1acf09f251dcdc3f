"use strict";
(async function () {
{% include "figures.js" %}

{% include "mesh.js" %}

{% include "drive.js" %}

{% include "train.js" %}

  let page;
  let lists = [];
  const drawn = new Map();
  const seen = document.documentElement.dataset;

  // Lists of numbers stand in front, each with its decimals and the steps from one number to the next.
  function held(key, value) {
    if (key === "lists") lists = value.map(([decimals, ...steps]) => summed(steps, 10 ** decimals));
    if (value && value.list !== undefined) return lists[value.list];
    return dressed(key, value);
  }

  function summed(steps, scale) {
    let sum = 0;
    return steps.map((step) => (step === null ? null : (sum += step) / scale));
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
    const picture = meshPicture(mesh);
    const input = mesh.querySelector("input");
    const button = mesh.querySelector("button");
    const plane = mesh.querySelector(".plane");
    const zone = JSON.parse(plane.dataset.motion);

    function set() {
      const phase = Number(input.value);
      mesh.querySelector("output").textContent = picture.set(phase);
      lines(phase);
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
      drawn.forEach((line, lane) => {
        const entered = phase + lane;
        const found = ends(entered);
        const at = (share) => [share * zone.width, -(entered - zone.beta * share) * zone.pitch];
        const middle = entered - zone.beta / 2;
        const crosses = found && zone.beta && middle >= -1e-9 && middle <= zone.alpha + 1e-9;
        for (const one of [line, names[lane]]) one.setAttribute("visibility", found ? "visible" : "hidden");
        dots[lane].setAttribute("visibility", crosses ? "visible" : "hidden");
        if (!found) return;
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
      if (now) now.textContent = Number((zone.of_mm * length).toPrecision(4)) + " " + zone.unit + " now;";
    }

    let timer = 0;
    button.addEventListener("click", () => {
      if (timer) {
        clearInterval(timer);
        timer = 0;
      } else {
        timer = setInterval(() => {
          input.value = picture.onward(Number(input.value));
          set();
        }, 60);
      }
      button.textContent = timer ? "Stop" : "Play";
    });
    input.addEventListener("input", set);
    input.value = 0.25;
    set();
  }

  function drive(place) {
    const picture = drivePicture(place);
    const turn = place.querySelector(".turn");
    const where = place.querySelector(".place");
    const output = place.querySelector("output");
    const told = place.querySelector(".where");
    let factor = 1;

    function set() {
      output.textContent = picture.set(Number(turn.value), { middle: Number(where.value), factor });
      told.textContent = "p = " + signed(Number(where.value).toFixed(1)) + "°";
    }

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
  document.querySelectorAll(".train").forEach(train);
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
    page = JSON.parse(await opened("figures"), held);
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
  // On paper everything is open but sections that the case is not about; colours are those of white paper.
  let restore = [];
  window.addEventListener("beforeprint", () => {
    const alone = seen.alone !== undefined;
    const folded = alone ? [] : [...document.querySelectorAll("details:not([open], .beside, .elsewhere)")];
    const hidden = alone ? [] : [...document.querySelectorAll(".pane[hidden]")];
    for (const one of folded) one.open = true;
    for (const one of hidden) one.hidden = false;
    restore = folded.map((one) => () => (one.open = false));
    restore.push(...hidden.map((one) => () => (one.hidden = true)), ...(dark.matches ? whitened() : []));
    const sheet = document.querySelector("#one-page > div");
    if (sheet) fit(sheet);
    for (const place of places) {
      const summed = place.closest("#one-page");
      if (summed || !(alone || place.closest(".beside:not([open])"))) draw(place).then(() => print(place, !summed));
    }
  });
  window.addEventListener("afterprint", () => {
    for (const undo of restore) undo();
    delete seen.alone;
  });
  document.getElementById("print-one-page")?.addEventListener("click", () => {
    seen.alone = "";
    window.print();
  });

  // The page that sums up, as large as one sheet takes it, 688 by 1005 pixels within its margins.
  function fit(sheet) {
    const fits = (scale) => {
      sheet.style.zoom = scale;
      sheet.style.width = `${688 / scale}px`;
      return sheet.getBoundingClientRect().height <= 1005;
    };
    let [small, large] = fits(1) ? [1, 1] : [0.3, 1];
    while (large - small > 0.005) {
      const scale = (small + large) / 2;
      if (fits(scale)) small = scale;
      else large = scale;
    }
    fits(small);
  }

  // A figure in the colours of white paper, half as wide as a page; one that has a row to itself as wide as a page.
  function print(place, resized) {
    const { data, layout } = place;
    const width = place.closest(".glance") ? 270 : place.closest(".figures > :last-child:nth-child(odd)") ? 688 : 338;
    const size = resized ? { width, height: 184 } : {};
    const paper = dark.matches ? JSON.parse(JSON.stringify({ data, layout }), whiter) : { data, layout };
    restore.push(() => Plotly.react(place, data, layout).then(() => Plotly.Plots.resize(place)));
    return Plotly.react(place, paper.data, { ...paper.layout, autosize: !resized, font: { ...paper.layout.font, size: 9 }, ...size });
  }
})();
