// Running stations: which there are, the picture of one, and a word or a mark sent back. It asks only while it is shown.
//
// kit: what school.mjs has for every view.

const kBetween = 33;      // between two pictures  [ms]
const kSoon = 8;          // where the next one is on its way
const kNone = 250;        // where there is none
const kListEvery = 2000;  // [ms]

const pause = time => new Promise(go => setTimeout(go, time));

function facts_of(kit, station) {
  const { say, number } = kit;
  return [[say("learner"), station.learner || "–"], [say("case"), station.case || "–"], [say("mode"), station.mode || "–"], [say("step"), station.step || "–"],
    [say("duration"), number(Number(station.seconds)) + " s"], [say("force_now"), number(Number(station.force)) + " N"]];
}

export async function live(kit, name) {
  return name === undefined ? stations(kit) : station(kit, name);
}

async function stations(kit) {
  const { el, say, ask, link, to, table } = kit;
  const place = el("div", { "aria-live": "polite" });
  const draw = all => {
    if (all.stations.length === 0) return place.replaceChildren(el("p", {}, say("no_stations")));
    place.replaceChildren(table(say("stations"), [[say("station")], [say("learner")], [say("case")], [say("mode")], [say("step")]],
      all.stations.map(one => [link(to("live", one.name), one.name), one.learner || "–", one.case || "–", one.mode || "–", one.step || "–"])));
  };
  let before = "";
  const look = async () => {
    const all = await ask("live");
    const seen = JSON.stringify(all.stations.map(({ name, learner, case: work, mode, step }) => [name, learner, work, mode, step]));
    if (seen !== before) draw(all);  // what stands still is not read out again
    before = seen;
  };
  await look();
  (async () => {
    while (!place.isConnected) await pause(50);
    while (place.isConnected) {
      await pause(kListEvery);
      if (place.isConnected && !document.hidden) await look().catch(() => {});
    }
  })();
  return [el("h1", {}, say("stations")), place];
}

async function station(kit, name) {
  const { el, say, ask, facts, post } = kit;
  const find = async () => (await ask("live")).stations.find(one => one.name === name);
  const first = await find();
  if (!first) throw new Error(say("station_gone"));
  const image = el("img", { class: "live", alt: say("live_picture", { name }) });
  const ring = el("span", { class: "ring", hidden: "" });
  const state = el("p", { role: "status" }, say("waiting_picture"));
  const text = el("input", { id: "word", maxlength: 200, autocomplete: "off" });
  const send = el("button", { type: "button" }, say("send"));
  const unmark = el("button", { type: "button", hidden: "" }, say("take_mark_away"));
  const known = el("div"), sent = el("ul");
  let number = 0, shown = 0, mark = null, rate = 0;

  const set_mark = place => {
    mark = place && { at: place, picture: shown };
    ring.hidden = unmark.hidden = !mark;
    if (mark) {
      ring.style.left = 100 * place[0] + "%";
      ring.style.top = 100 * place[1] + "%";
    }
  };
  image.addEventListener("click", event => {
    const box = image.getBoundingClientRect();
    if (shown) set_mark([(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height].map(x => Math.min(1, Math.max(0, x))));
  });
  unmark.addEventListener("click", () => set_mark(null));
  const say_it = async () => {
    const word = text.value.trim();
    if (!word && !mark) return text.focus();
    try {
      await post("live/say", { station: name, text: word, ...(mark && { mark: mark.at, picture: mark.picture }) });
      text.value = "";
      set_mark(null);
      await look();
    } catch (trouble) {
      state.textContent = trouble.message;
    }
  };
  send.addEventListener("click", say_it);
  text.addEventListener("keydown", event => { if (event.key === "Enter") say_it(); });

  const look = async () => {
    const now = await find();
    if (!now) {
      state.textContent = say("station_gone");
      return;
    }
    known.replaceChildren(facts(facts_of(kit, now)));
    sent.replaceChildren(...now.messages.map(one => el("li", {}, (one.marked ? "◎ " : "") + (one.text || say("mark")), " – ", say(one.seen ? "station_has_it" : "on_its_way"))));
  };
  await look();
  const pictures = async () => {
    while (!image.isConnected) await pause(50);
    let last = performance.now(), count = 0;
    while (image.isConnected) {
      if (document.hidden) { await pause(kNone); continue; }
      try {
        const began = performance.now();
        const answer = await kit.raw("live/picture?" + new URLSearchParams({ station: name, after: number }));
        if (answer.status === 200) {
          number = Number(answer.headers.get("X-Burr-Picture"));
          const address = URL.createObjectURL(await answer.blob());
          image.src = address;
          await image.decode().catch(() => {});
          URL.revokeObjectURL(address);
          shown = number;
          ++count;
          state.textContent = rate ? say("live_rate", { n: rate }) : "";
          await pause(Math.max(0, kBetween - (performance.now() - began)));
        } else {
          if (answer.status === 404) state.textContent = say("station_gone");
          await pause(answer.status === 202 && number ? kSoon : kNone);
        }
      } catch (trouble) {
        state.textContent = trouble.message;
        await pause(1000);
      }
      const now = performance.now();
      if (now - last >= 2000) {
        rate = Math.round(1000 * count / (now - last));
        image.dataset.rate = String(rate);
        [last, count] = [now, 0];
      }
    }
  };
  pictures();
  (async () => {
    while (!image.isConnected) await pause(50);
    while (image.isConnected) {
      await pause(1000);
      if (image.isConnected && !document.hidden) await look().catch(() => {});
    }
  })();
  return [el("h1", {}, name), known, state, el("div", { class: "live-frame" }, image, ring), el("p", { class: "note" }, say("live_note")),
    el("div", { class: "row" }, el("label", { for: "word" }, say("word_to_station")), text, send, unmark), el("h2", {}, say("said")), sent];
}
