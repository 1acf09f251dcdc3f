// What a person would see to be wrong, in a window so many pixels wide or on paper that is as high as told.
(([width, height]) => {
  const drawn = ".scatterlayer path, .heatmaplayer image, .contourlayer path, .barlayer path, .imagelayer image";
  const faults = [];
  const shown = (one) => one.checkVisibility({ visibilityProperty: true }) && one.getClientRects().length > 0;
  const box = (one) => one.getBoundingClientRect();
  const name = (one) => `${one.localName}${one.id && "#" + one.id} "${one.textContent.trim().slice(0, 40)}"`;
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2 &&
    Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.3 * Math.min(a.height, b.height);

  if (document.documentElement.scrollWidth > width) faults.push("the page is wider than its window");
  for (const one of document.querySelectorAll("main *:not(svg *):not(.plot *)")) {
    if (!shown(one) || one.closest(".scroll, .spoken, .tabbed > .pane > h3")) continue;
    if (box(one).right > width + 1 || box(one).left < -1) faults.push("out of the window: " + name(one));
    if (height && /^(FIGURE|TR|svg)$/.test(one.nodeName) && box(one).height > height) faults.push("higher than a page: " + name(one));
  }
  if (height) for (const one of document.querySelectorAll(".scroll")) {
    if (shown(one) && one.scrollWidth > one.clientWidth + 1) faults.push("wider than the paper: " + name(one));
  }

  // Columns behind the edge of a narrow window, but for tables whose first one stays where the others pass.
  if (!height) for (const one of document.querySelectorAll(width > 500 ? ".scroll" : ".scroll:not(:has(> .wide))")) {
    if (shown(one) && one.scrollWidth > one.clientWidth + 1) faults.push("behind the edge of the window: " + name(one));
  }

  for (const one of document.querySelectorAll(".tiles > div, .card, p, dd, figcaption, h1, h2, h3, h4")) {
    if (shown(one) && !one.closest(".spoken, .plot") && one.scrollWidth > one.clientWidth + 1 && one.clientWidth) faults.push("wider than its place: " + name(one));
  }

  // Words of heads and names that are broken where they have no hyphen and no point.
  const word = document.createRange();
  for (const one of document.querySelectorAll("thead th, dt, h1, h2, h3, h4, figcaption, caption, .keys span, strong, .tiles dd, .facts dd, .inputs :is(td, th)")) {
    if (!shown(one) || one.closest(".spoken, .plot")) continue;
    const texts = document.createTreeWalker(one, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) for (const { 0: letters, index } of texts.currentNode.data.matchAll(/[\p{L}\p{N}]+/gu)) {
      word.setStart(texts.currentNode, index);
      word.setEnd(texts.currentNode, index + letters.length);
      const lines = [...word.getClientRects()].filter((part) => part.width > 0);
      if (lines.some((part) => part.top > lines[0].bottom - 2)) faults.push(`"${letters}" is broken: ${name(one)}`);
    }
  }

  // First cells of the row and of the column of a cell.
  const heads = (cell) => {
    const row = cell.closest("tr");
    return row ? row.cells[0].textContent + (row.closest("table").tHead?.rows[0].cells[cell.cellIndex]?.textContent ?? "") : "";
  };

  // Units on another line than their numbers, numbers on another than their symbol; values of tiles are narrow.
  for (const one of document.querySelectorAll("p, dd, li, td, th, figcaption, caption, summary")) {
    if (!shown(one) || one.closest(".spoken, .plot")) continue;
    const raw = one.textContent.match(/\d (deg[CF]?|(N\/)?um|urad|mm2|mm3)\b|\d x \d/);
    if (raw && !one.closest("code") && !one.querySelector("pre, code")) faults.push(`"${raw[0]}" is not as printed: ${name(one)}`);
    const read = document.createTreeWalker(one, NodeFilter.SHOW_TEXT);
    while (read.nextNode()) {
      const { data: words, parentElement: inside } = read.currentNode;
      if (inside.closest("code, pre, .key, #sources")) continue;
      const raised = words.match(/(?<![\p{L}\p{N}_.\/])\p{L}_[\p{L}\p{N}]{1,5}(?![\p{L}\p{N}_(.])/u);
      if (raised) faults.push(`"${raised[0]}" is not set low: ${name(one)}`);
      const many = one.matches("td, th") ? null : [...words.matchAll(/(?<![\w.\/])\d+\.\d+(?![\w.\/])/g)].find(([it]) => it.replace(".", "").replace(/^0+/, "").length > 6);
      if (many) faults.push(`${many[0]} has more digits than anybody reads: ${name(one)}`);
      const power = words.match(/\de[−-]\d+ (k?g|[kM]?N|[MG]?Pa|percentage|[mµ]?m|[km]?W|µ?J)(?![\w/])/) ??
        (/\[(k?g|[kM]?N|k?W|µ?J)( |\])/.test(heads(one)) ? words.match(/\de[−-]?\d/) : null);
      if (power) faults.push(`"${power[0]}" could have a smaller unit: ${name(one)}`);
    }
    const texts = document.createTreeWalker(one, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) for (const { 0: pair, index } of texts.currentNode.data.matchAll(/\d[ \u00a0]([%°µ]|([kMG]?(N|Pa|W|g|Hz)|[mkc]?m|m?s|rpm|arcmin)(?![\w-]))|(?<![^\s(])[^\s="]{1,7} = [−-]?\d/g)) {
      if (texts.currentNode.parentElement.closest("strong, .big, option")) continue;
      const lines = [index, index + pair.length - 1].map((at) => {
        word.setStart(texts.currentNode, at);
        word.setEnd(texts.currentNode, at + 1);
        return word.getBoundingClientRect();
      });
      if (lines[0].height && lines[1].top > lines[0].bottom - 2) faults.push(`"${pair}" is parted: ${name(one)}`);
    }
  }

  // Parts of one parent that stand in the way of each other.
  for (const parent of document.querySelectorAll("main, section, .pane, details, .card, .tiles, .facts, .figures, figure, .halves, .halves > div")) {
    const parts = [...parent.children].filter((one) => {
      const style = getComputedStyle(one);
      return shown(one) && style.float === "none" && style.position === "static" && style.display !== "inline";
    });
    parts.forEach((one, k) => {
      for (const other of parts.slice(k + 1, k + 3)) {
        if (meet(box(one), box(other))) faults.push(`overlap: ${name(one)} and ${name(other)}`);
      }
    });
  }

  const light = (colour) => {
    const [r, g, b] = colour.match(/[\d.]+/g).map((v) => v / 255).map((v) => (v > 0.03928 ? ((v + 0.055) / 1.055) ** 2.4 : v / 12.92));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
  };
  const ground = light(height ? "rgb(255, 255, 255)" : getComputedStyle(document.querySelector("section")).backgroundColor);
  const painted = document.createElement("i");
  document.body.append(painted);
  const shade = (colour) => light(((painted.style.color = colour), getComputedStyle(painted).color));
  for (const plot of document.querySelectorAll(".plot")) {
    if (!shown(plot)) continue;
    const say = (words) => faults.push(`figure ${plot.id}: ${words}`);
    const marks = [...plot.querySelectorAll(drawn)].map(box);
    if (!marks.some((one) => one.width + one.height > 1)) say("empty");
    // Half of a map is at most as light as this, where everything around it is dark.
    for (const { colorscale, z, zmin, zmax } of ground < 0.5 && !height ? plot._fullData.filter((one) => one.z && one.showscale) : []) {
      const values = z.flatMap((row) => [...row]).filter(Number.isFinite).sort((a, b) => a - b);
      const place = (values[values.length >> 1] - zmin) / (zmax - zmin);
      const stop = colorscale.findLast(([at]) => at <= Math.min(Math.max(place, 0), 1));
      if (shade(stop[1]) > 0.45) say("a bright map on dark paper");
    }
    for (const axis of ["xtick", "ytick"]) {
      const labels = [...plot.querySelectorAll(`.${axis} text`)].map((one) => one.textContent.trim()).filter(Boolean);
      const long = labels.find((words) => /0\.0*[1-9]\d*/.test(words) && /0\.\d{5}/.test(words) && !/0\.0*1$/.test(words) || /\d\s\d{3}\s\d{3}/.test(words));
      if (long) say(`"${long}" has many digits for an axis`);
      if (labels.length === 1 && /^[\d.,\s−]+$/.test(labels[0])) say(`"${labels[0]}" alone on an axis`);
    }
    const aslant = [...plot.querySelectorAll(".xtick text")].find((one) => shown(one) && Math.abs(one.getScreenCTM().b) > 0.01);
    if (aslant) say(`"${aslant.textContent}" is turned`);
    const level = (one) => Math.min(Math.abs(one.getScreenCTM().a), Math.abs(one.getScreenCTM().b)) < 0.01;
    const texts = [...plot.querySelectorAll("text")].filter((one) => shown(one) && one.textContent.trim() && level(one));
    const [outer, boxes] = [box(plot), texts.map(box)];
    if (height && box(plot.closest("figure")).width > 1.3 * box(plot.querySelector(".main-svg")).width) say("blank beside it");
    const legend = plot.closest("figure").querySelector(".keys");
    for (const one of legend ? [...texts, legend] : texts) {
      const raw = one.textContent.match(/(?<![\p{L}\p{N}_.])[ΔΣd]?\p{L}_\p{L}\w*/u);
      if (raw) say(`"${raw[0]}" is not set as an index`);
    }
    texts.forEach((one, k) => {
      const at = boxes[k];
      if (at.left < outer.left - 2 || at.right > outer.right + 2 || at.top < outer.top - 2 || at.bottom > outer.bottom + 2) say(`cut: "${one.textContent}"`);
      for (let other = k + 1; other < texts.length; other++) {
        if (meet(at, boxes[other])) say(`"${one.textContent}" on "${texts[other].textContent}"`);
      }
      if (one.closest(".infolayer, .xaxislayer-above, .yaxislayer-above")) {
        const [a, b] = [light(getComputedStyle(one).fill), ground];
        if (Math.max(a, b) / Math.min(a, b) < 3) say(`"${one.textContent}" cannot be told from its ground`);
      }
    });
  }

  for (const figures of height ? [] : document.querySelectorAll(".figures")) {
    const drawings = [...figures.querySelectorAll(":scope > figure")].filter((one) => shown(one) && one.querySelector(".plot"));
    drawings.forEach((one, k) => {
      const other = drawings[k + 1];
      const [a, b] = [one, other].map((it) => it && box(it.querySelector(".plot")).top);
      if (other && Math.abs(box(one).top - box(other).top) < 2 && Math.abs(a - b) > 2) faults.push(`not level with the figure beside it: ${name(one)}`);
    });
  }

  painted.remove();

  // Lines of legends, which have the colours of those in figures.
  for (const one of document.querySelectorAll(".legend line, .keys line")) {
    if (!shown(one) || height || ground > 0.5) continue;
    const [a, b] = [light(getComputedStyle(one).stroke), ground];
    if (Math.max(a, b) / Math.min(a, b) < 3) faults.push(`line ${one.getAttribute("stroke")} cannot be told from its ground: ${name(one.closest("label, span"))}`);
  }

  // Pages of paper as columns that are as high, which the browser parts by the same rules.
  if (height) {
    const main = document.querySelector("main");
    const summed = document.querySelector("#one-page");
    const styles = [main, summed].map((one) => one?.style.cssText ?? "");
    if (summed) summed.style.display = "none";
    main.style.cssText += `; columns: ${width}px; column-gap: 0; column-fill: auto; height: ${height}px`;
    const page = (one) => Math.floor((one.left - box(main).left + 2) / width);
    for (const one of main.querySelectorAll("figure, .mesh svg, .drive svg, tr, .card, .tiles > div, .legend, h2, h3, h4")) {
      const parts = [...one.getClientRects()].filter((part) => part.height > 1);
      if (shown(one) && new Set(parts.map(page)).size > 1) faults.push("parted by the end of a page: " + name(one));
    }
    const ends = (one, last) => page([...one.getClientRects()].filter((part) => part.height > 1).at(last ? -1 : 0));
    const after = (one) => {
      let next = one.nextElementSibling;
      while (next && !shown(next)) next = next.nextElementSibling;
      return next && ([...next.querySelectorAll("figure, tr, p, li, dd, svg")].find(shown) ?? next);
    };
    for (const one of main.querySelectorAll("h2, h3, h4, summary, .legend, .marks, p:has(+ .marks), .figures")) {
      const above = one.matches(".figures") ? one.previousElementSibling?.closest("p, h3, h4") : one;
      const below = one.matches(".figures") ? one.querySelector("figure") : after(one);
      if (above && below && shown(above) && shown(below) && ends(above, true) !== ends(below)) faults.push("left behind at the end of a page: " + name(above));
    }
    const lasts = [...main.querySelectorAll("figure, tr, p, li, svg, h2, h3")].filter(shown).flatMap((one) => [...one.getClientRects()]);
    const end = Math.max(...lasts.map(page));
    const bottom = Math.max(...lasts.filter((part) => page(part) === end).map((part) => part.bottom)) - box(main).top;
    if (end > 0 && bottom < 0.12 * height) faults.push("the last page is nearly empty");
    for (const rows of [...main.querySelectorAll("tbody")].map((body) => [...body.rows].filter(shown))) {
      for (const [one, other] of [rows.slice(0, 2), rows.slice(-2).reverse()]) {
        if (other && ends(one) !== ends(other)) faults.push("a row alone beside the end of a page: " + name(one));
      }
    }
    [main, summed].forEach((one, k) => { if (one) one.style.cssText = styles[k]; });
  }
  return [...new Set(faults)];
})
