  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const config = { displayModeBar: false, responsive: true, showTips: false };
  const touch = window.matchMedia("(pointer: coarse)").matches;

  // Colours are given for white paper; on dark paper light and dark change places, hues stay. Lines and marks,
  // whose key is `color`, are lightened until they stand out 3 to 1, as WCAG 2.2 asks of graphics.
  const onWhite = new Map();
  function lit(colour, least = 0) {
    const full = colour.length === 4 ? colour.replace(/[0-9a-f]/gi, "$&$&") : colour;
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(full.slice(at, at + 2), 16) / 255);
    const [low, high] = [Math.min(r, g, b), Math.max(r, g, b)];
    const [light, span] = [(low + high) / 2, high - low];
    const [first, second] = high === r ? [g - b, 0] : high === g ? [b - r, 2] : [r - g, 4];
    const hue = span ? (60 * (first / span + second) + 360) % 360 : 0;
    let lightness = Math.round(100 - 88 * light);
    // Grounds of zones and maps stay as pale: a tint that keeps its share is strong where it is dark.
    const of = light < NEARLY_WHITE ? light : lightness / 100;
    const share = span ? span / (1 - Math.abs(2 * of - 1)) : 0;
    while (light < NEARLY_WHITE && contrast(hue, 0.8 * share, lightness / 100) < least) lightness++;
    const turned = `hsl(${hue.toFixed(0)}, ${(80 * share).toFixed(0)}%, ${lightness}%)`;
    onWhite.set(turned, colour);
    return turned;
  }

  // Of a colour by hue, saturation and lightness with the dark paper, whose luminance is 0.0139.
  function contrast(hue, saturation, lightness) {
    const part = (n) => {
      const at = (n + hue / 30) % 12;
      const value = lightness - saturation * Math.min(lightness, 1 - lightness) * Math.max(-1, Math.min(at - 3, 9 - at, 1));
      return value > 0.03928 ? ((value + 0.055) / 1.055) ** 2.4 : value / 12.92;
    };
    return (0.2126 * part(0) + 0.7152 * part(8) + 0.0722 * part(4) + 0.05) / 0.0639;
  }
  const LEAST = 3.05;  // what is rounded is no less than 3
  const NEARLY_WHITE = 0.85;  // from here on a colour is a ground or a rim, no line

  // What `lit` did, taken back for white paper.
  const unlit = (words) => words.replace(/hsl\(\d+, \d+%, \d+%\)/g, (turned) => onWhite.get(turned) ?? turned);
  const whiter = (key, value) => (key.endsWith("bgcolor") ? "#fff" : typeof value === "string" ? unlit(value) : value);

  // Drawings of the page in the colours of white paper; what puts them back.
  function whitened() {
    return ["stroke", "fill", "style"].flatMap((name) =>
      [...document.querySelectorAll(`[${name}*="hsl("]`)].filter((one) => !one.closest(".plot")).map((one) => {
        const value = one.getAttribute(name);
        one.setAttribute(name, unlit(value));
        return () => one.setAttribute(name, value);
      })
    );
  }

  function dressed(key, value) {
    if (dark.matches && key.endsWith("bgcolor")) return getComputedStyle(document.body).getPropertyValue("--paper").trim();
    const colour = dark.matches && typeof value === "string" && /^#([0-9a-f]{3}){1,2}$/i.test(value);
    return colour && key !== "name" && key !== "text" ? lit(value, key === "color" ? LEAST : 0) : value;
  }

  if (dark.matches) {
    for (const one of document.querySelectorAll('[stroke^="#"], [fill^="#"], [style*="#"]')) {
      for (const name of ["stroke", "fill", "style"]) {
        const value = one.getAttribute(name);
        if (value) one.setAttribute(name, value.replace(/#[0-9a-f]{6}\b/gi, (colour) => lit(colour, LEAST)));
      }
    }
  }
  dark.addEventListener("change", () => location.reload());

  // Bytes of a text that holds four in five characters of these, the last of them perhaps fewer.
  function unpacked(text) {
    const digits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%,()*+-;.=:?@^_`{|}~";
    const value = new Uint8Array(128);
    for (let k = 0; k < 85; k++) value[digits.charCodeAt(k)] = k;
    const groups = Math.ceil(text.length / 5);
    const bytes = new DataView(new ArrayBuffer(4 * groups));
    for (let group = 0; group < groups; group++) {
      let sum = 0;
      for (let k = 5 * group; k < 5 * group + 5; k++) sum = 85 * sum + (k < text.length ? value[text.charCodeAt(k)] : 84);
      bytes.setUint32(4 * group, sum);
    }
    return bytes.buffer.slice(0, 4 * groups - (5 * groups - text.length));
  }

  // Text that stands in the page compressed.
  async function opened(id) {
    const packed = document.getElementById(id).textContent;
    const stream = new Blob([unpacked(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).text();
  }

  async function unpack(id) {
    const script = document.createElement("script");
    script.textContent = await opened(id);
    document.head.append(script);
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

  // Where a spreadsheet would begin a formula, also one whose cells end at semicolons or tabs.
  const FORMULA = /(^|[;\t\r\n])(?=\s*[=+@\-\uff1d\uff0b\uff0d\uff20])/g;

  // Values of the curves that are shown, one point a line.
  function table(place) {
    const cell = (value) => {
      if (value === null || value === undefined) return "";
      if (typeof value === "number") return String(value);
      const words = bare(String(value)).replace(FORMULA, "$1'");
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
