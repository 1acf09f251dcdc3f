  // Teeth on bodies that turn or travel by the nominal motion: what places them at a phase, and tells the pairs.
  function meshPicture(mesh) {
    const motion = JSON.parse(mesh.dataset.motion);
    const gears = mesh.querySelectorAll(".close .gear");
    const contacts = mesh.querySelectorAll(".contact");

    function between(place) {
      const points = motion.points;
      for (let k = 1; k < points.length; k++) {
        if (place <= points[k][1] + 1e-9) return points[k - 1][0] + " to " + points[k][0];
      }
      return "";
    }

    function set(phase) {
      for (const gear of gears) {
        const turn = Number(gear.dataset.turn) + phase * Number(gear.dataset.spin);
        const [x, y] = gear.dataset.place.split(" ").map(Number);
        const [across, down] = gear.dataset.travel.split(" ").map(Number);
        const place = `${x + phase * across} ${y + phase * down}`;
        gear.setAttribute("transform", `translate(${place}) rotate(${turn})`);
      }
      const places = [];
      let pairs = 0;
      contacts.forEach((contact, lane) => {
        if (phase + lane <= motion.total + 1e-9) pairs += 1;
        const place = phase + lane - motion.behind;
        const touches = place >= -1e-9 && place <= motion.ratio + 1e-9;
        contact.setAttribute("visibility", touches ? "visible" : "hidden");
        contact.setAttribute("cx", motion.start[0] + motion.step[0] * (phase + lane));
        contact.setAttribute("cy", motion.start[1] + motion.step[1] * (phase + lane));
        if (touches) places.push(place.toFixed(2) + (motion.behind ? "" : " (" + between(place) + ")"));
      });
      const where = motion.behind ? "; in this section at base pitches from A: " : ", base pitches from A: ";
      return (
        "phase " + phase.toFixed(2) + ": " + (pairs === 1 ? "1 pair" : pairs + " pairs") + " in contact" +
        where + (places.join(", ") || "none")
      );
    }

    const onward = (phase, by = 1 / 48) => (((phase + motion.direction * by) % 1) + 1) % 1;
    return { set, onward, direction: motion.direction };
  }
