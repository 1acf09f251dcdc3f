  // Gears of a set and their carrier, turned by their rates for a turn of the input.
  function train(place) {
    const turning = place.querySelectorAll("[data-rate]");
    const input = place.querySelector("input");
    const button = place.querySelector("button");
    const output = place.querySelector("output");
    let turns = 0;
    let timer = 0;

    function set() {
      for (const one of turning) {
        const angle = Number(one.dataset.turn) + 360 * turns * Number(one.dataset.rate);
        one.setAttribute("transform", `rotate(${angle % 360})`);
      }
      output.textContent = turns.toFixed(2);
    }

    button.addEventListener("click", () => {
      clearInterval(timer);
      timer = timer ? 0 : setInterval(() => {
        turns += 1 / 400;
        input.value = turns % 1;
        set();
      }, 40);
      button.textContent = timer ? "Stop" : "Play";
    });
    input.addEventListener("input", () => {
      turns = Math.floor(turns) + Number(input.value);
      set();
    });
    set();
  }
