// A recorded session in 3D, with its time line; two sessions beside each other, step by step. The bone is drawn by burr's own
// renderer (/page/, the page "replay" of web/pages), the recording comes from the server that serves this page.
//
// kit: what school.mjs has for every view: el, say, ask, link, to, number, time, textOf, table, facts, language().

const kSpeeds = [0.25, 0.5, 1, 2, 4, 8, 16];
const kTurn = 0.006;             // of the view, per pixel of the pointer  [rad]
const kRing = 1.2e-3, kRound = 20e-3;  // around a place of evidence: the ring's radius, the height of the picture  [m]
const kWide = 1000, kHigh = 132;  // of a time line, in its own units
const pages = "/page/";

const turn = () => new Promise(go => requestAnimationFrame(go));

// ---- the bone

let modules = null;  // of /page/, loaded once
async function view_of_bones(kit) {
  modules ??= Promise.all(["common/burr.js", "common/skin.js", "common/canvas.js", "common/words.js"].map(file => import(pages + file)))
    .then(async ([burr, skin, canvas, words]) => {
      await words.load();
      return { compiled: await burr.compile(), start: burr.start, show: skin.show, begin_bone: skin.begin_bone, fit: canvas.fit, is_lost: canvas.is_lost, wanted_size: canvas.wanted_size, words };
    });
  try {
    const all = await modules;
    await all.words.choose(kit.language());
    return all;
  } catch {
    modules = null;
    throw new Error(kit.say("no_bone_view"));
  }
}

// Parts of the recording, one after the other: a long session is some hundred megabytes.
async function recording_of(kit, line, progress) {
  const parts = [];
  for (let from = 0; from < line.bytes;) {
    progress(from / line.bytes);
    const part = await kit.ask("replay/recording?" + new URLSearchParams({ session: line.session, from }));
    if (part.size === 0) throw new Error(kit.say("recording_cut"));
    parts.push(part);
    from += part.size;
  }
  return new File(parts, line.name);
}

let opening = Promise.resolve();  // the renderer finds its canvas by the name "picture": one after the other

class Scene {
  constructor(kit) {
    this.kit = kit;
    this.canvas = kit.el("canvas", { tabindex: 0, class: "bone", "aria-label": kit.say("bone_picture") });
    this.state = kit.el("p", { role: "status", class: "bone-state" });
    this.ring = kit.el("div", { class: "bone-ring", hidden: "" });
    this.element = kit.el("div", { class: "bone-frame" }, this.canvas, this.ring, this.state);
    this.place = null;   // of evidence [m]: a ring marks it
    this.turns = false;  // the view has not been turned to it yet
    this.waiting = [];
    this.dirty = true;
    this.wanted = null;
    this.shown = null;   // the moment that is shown  [s]
    this.ready = this.asked = this.seen = this.over = false;
    this.before = 0;
    this.heard = () => {};
    this.moved = () => {};
  }

  // From the first word to the first picture. A trouble is written where the picture would be.
  async open(line) {
    try {
      const progress = share => this.tell(this.kit.say("fetching", { percent: Math.round(100 * share) }));
      progress(0);
      const parts = await view_of_bones(this.kit);
      const file = await recording_of(this.kit, line, progress);
      const bone = line.bone_bytes > 0
        ? new Uint8Array(await (await this.kit.ask("replay/bone?" + new URLSearchParams({ session: line.session }))).arrayBuffer()) : null;
      while (!this.canvas.isConnected) {
        if (this.over) return;
        await turn();
      }
      const mine = opening.then(() => this.start(parts));
      opening = mine.catch(() => {});
      await mine;
      this.tell(this.kit.say("unpacking"));
      this.worker = new Worker(new URL("replay/worker.js", location.origin + pages), { type: "module" });
      this.worker.onmessage = ({ data }) => this.hear(data);
      this.worker.onerror = what => this.fail(what.message || "worker");
      this.worker.postMessage({ kind: "open", file, bone, work: 1 });
      requestAnimationFrame(now => this.draw(now));
    } catch (trouble) {
      this.fail(trouble.message);
    }
  }

  async start(parts) {
    this.parts = parts;
    this.canvas.id = "picture";
    this.view = await parts.start(parts.compiled);
    const opened = this.view.view_open(...parts.wanted_size(this.canvas));
    this.canvas.removeAttribute("id");
    if (opened === 0) throw new Error(this.view.text(this.view.view_why()));
    this.view.view_bone(0.5);
    this.listen();
  }

  tell(text) { this.state.textContent = text; }
  fail(text) {
    if (this.over) return;
    this.tell(text);
    this.state.classList.add("wrong");
    this.end();
  }
  end() {
    this.over = true;
    this.worker?.terminate();
  }

  hear(data) {
    const { words } = this.parts, view = this.view;
    switch (data.kind) {
      case "opened":
        this.parts.begin_bone(view, data.tissues, data.voxel, data.rate, data.mouse);
        break;
      case "skin": this.waiting.push(...data.patches); break;
      case "soft": this.waiting.push(...data.parts.map(one => ({ ...one, soft: true }))); break;
      case "ready":
        this.ready = true;
        this.tell("");
        this.wanted ??= 0;
        break;
      case "moment":
        this.waiting.push(...data.patches, { row: data.row }, { held: data.held });
        this.shown = data.time;
        this.asked = false;
        break;
      case "refused": this.fail(words.word(data.why, ...data.parts)); break;
      case "broken": this.fail(data.why ? words.word(data.why, ...data.parts) : data.text); break;
    }
    this.dirty = true;
  }

  seek(time) { this.wanted = time; }
  // The place of what is judged [mm], or null: the view turns to it, and a ring marks it.
  look_at(place_mm) {
    this.place = place_mm?.map(value => value / 1000) ?? null;
    this.turns = this.place !== null;
    this.dirty = true;
  }
  draw_ring() {
    this.ring.hidden = this.place === null;
    if (this.place === null) return;
    const [x, y, r] = this.view.numbers(this.view.view_place(...this.place, kRing), 3), scale = this.canvas.clientHeight / Math.max(1, this.canvas.height);
    const wide = Math.max(8, scale * r);
    this.ring.hidden = r < 0;
    Object.assign(this.ring.style, { left: `${this.canvas.offsetLeft + scale * x - wide}px`, top: `${this.canvas.offsetTop + scale * y - wide}px`, width: `${2 * wide}px`, height: `${2 * wide}px` });
  }

  draw(now) {
    if (this.over) return;
    if (!this.canvas.isConnected) return this.end();  // another view was chosen
    requestAnimationFrame(later => this.draw(later));
    try {
      const { view } = this, { show, fit } = this.parts;
      if (this.ready && this.wanted !== null && !this.asked) {
        this.worker.postMessage({ kind: "seek", time: this.wanted, work: 1 });
        this.wanted = null;
        this.asked = true;
      }
      const fresh = this.waiting.length > 0;
      for (const one of this.waiting) show(view, one);
      this.waiting = [];
      if (this.lost) return;
      if (fresh && !this.ready) view.view_anew();
      if (fresh && !this.seen && this.ready) {
        this.seen = true;
        view.view_whole();
      }
      if (this.turns && this.ready && this.seen && !this.asked && this.wanted === null) {  // the bone of that moment is there
        this.turns = false;
        view.view_turn_to(...this.place, kRound);
        this.dirty = true;
      }
      if (fit(this.canvas)) this.dirty = true;
      const took = this.drew ? now - this.before : 0;
      this.before = now;
      this.drew = this.dirty || fresh || view.view_refined() === 0;
      if (!this.drew) return;
      this.dirty = false;
      if (view.view_show(1e-3 * now, 1e-3 * took, 0) === 0) {
        if (this.parts.is_lost(this.canvas)) return this.lose();
        throw new Error(view.text(view.view_why()));
      }
      this.draw_ring();
      if (fresh && this.shown !== null) {
        const [, force, removed, size] = view.numbers(view.view_figures(), 8);
        this.heard({ time: this.shown, force, removed, size });
      }
    } catch (trouble) {
      this.fail(trouble.message);
    }
  }

  listen() {
    const { canvas, view } = this;
    let last = null;
    canvas.addEventListener("pointerdown", event => { canvas.setPointerCapture(event.pointerId); last = event; });
    canvas.addEventListener("pointermove", event => {
      if (!last || last.pointerId !== event.pointerId) return;
      const dx = event.clientX - last.clientX, dy = event.clientY - last.clientY;
      if (last.button === 1) view.view_pan(-dx / canvas.clientHeight, dy / canvas.clientHeight);
      else view.view_orbit(-kTurn * dx, kTurn * dy);
      last = { pointerId: event.pointerId, button: last.button, clientX: event.clientX, clientY: event.clientY };
      this.dirty = true;
    });
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { last = null; });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("wheel", event => {
      event.preventDefault();
      view.view_zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 33 : 1)));
      this.dirty = true;
    }, { passive: false });
    canvas.addEventListener("keydown", event => {
      const keys = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
      if (keys[event.key]) view.view_orbit(-kTurn * keys[event.key][0], kTurn * keys[event.key][1]);
      else if (event.key === "+" || event.key === "-") view.view_zoom(event.key === "+" ? 0.9 : 1.1);
      else if (event.key === "f" || event.key === "F") view.view_whole();
      else return;
      event.preventDefault();
      this.dirty = true;
    });
    // the browser has taken the picture away: it is made anew on another canvas, and the bone is still there
    canvas.addEventListener("webglcontextlost", event => {
      event.preventDefault();
      if (!this.over && !this.lost && canvas === this.canvas) this.lose();
    });
  }
  lose() {
    this.lost = true;
    this.view.view_lost();
    this.again(300);
  }
  again(wait) {
    setTimeout(() => {
      if (this.over) return;
      const fresh = this.canvas.cloneNode(false);
      this.canvas.replaceWith(fresh);
      this.canvas = fresh;
      opening = opening.then(() => {
        fresh.id = "picture";
        const opened = this.view.view_open(...this.parts.wanted_size(fresh));
        fresh.removeAttribute("id");
        if (opened === 0) return this.again(Math.min(5000, 2 * wait));
        this.lost = false;
        this.dirty = true;
        this.listen();
        this.view.view_anew();
      }).catch(() => {});
    }, wait);
  }
}

// ---- the time line

// The line as the server has it, when it is ready; progress(share, stage) meanwhile.
async function line_of(kit, session, progress) {
  for (;;) {
    const line = await kit.ask("replay?" + new URLSearchParams({ session }));
    if (line.seconds !== undefined) return line;
    progress(line.share);
    await new Promise(go => setTimeout(go, 400));
  }
}

// The points that were lost, by time: items that are not met and have a moment at which it is seen.
const lost_of = (session, line) => line.lost.map(({ id, at_s, at_end }) => ({ at: at_s, at_end, item: session.items.find(item => item.id === id) ?? { id } }))
  .sort((a, b) => a.at - b.at);

function chart(kit, line, lost, seek) {
  const { el, say, textOf, number } = kit;
  const x = t => kWide * Math.min(1, t / Math.max(1e-9, line.seconds));
  const out = el("svg", { viewBox: `0 0 ${kWide} ${kHigh}`, class: "line", preserveAspectRatio: "none", role: "img" });
  const most = Math.max(1, ...line.force_n.map(value => value ?? 0));
  const nearest = line.nearest_mm?.filter(value => value !== null) ?? [];
  out.append(el("title", {}, say("line_words", { seconds: number(line.seconds), force: number(most),
    distance: nearest.length ? number(Math.min(...nearest)) : "–" })));
  line.steps.forEach((step, n) => {
    const left = x(step.from_s), box = el("path", { class: n % 2 ? "step odd" : "step", d: `M${left} 0H${Math.max(left + 1, x(step.to_s))}V14H${left}Z` });
    box.append(el("title", {}, textOf(step.say, step.id)));
    out.append(box);
  });
  const count = line.force_n.length, each = kWide / count;
  line.cutting.forEach((cut, n) => { if (cut) out.append(el("path", { class: "cut", d: `M${n * each} 16h${each}v3h${-each}Z` })); });
  const curve = (values, top, bottom, of) => values.map((value, n) => value === null ? "" :
    `${n > 0 && values[n - 1] !== null ? "L" : "M"}${((n + 0.5) * each).toFixed(1)} ${(bottom - (bottom - top) * Math.min(1, value / of)).toFixed(1)}`).join("");
  out.append(el("path", { class: "force", d: curve(line.force_n, 22, 76, most) }), el("line", { class: "base", x1: 0, x2: kWide, y1: 76, y2: 76 }));
  if (line.nearest_mm) out.append(el("path", { class: "near", d: curve(line.nearest_mm, 80, 128, line.farthest_mm) }), el("line", { class: "base", x1: 0, x2: kWide, y1: 128, y2: 128 }));
  for (const event of line.events) {
    const mark = el("path", { class: "event " + event.kind.replace(/ /g, "_"), d: `M${x(event.at_s) - 4} 22h8l-4 8Z` });
    mark.append(el("title", {}, say("event_" + event.kind.replace(/ /g, "_")) + ", " + number(event.at_s) + " s"));
    out.append(mark);
  }
  for (const { at, item } of lost) {
    const mark = el("line", { class: "lost", x1: x(at), x2: x(at), y1: 22, y2: kHigh });
    mark.append(el("title", {}, textOf(item.say, item.id)));
    out.append(mark);
  }
  const now = el("line", { class: "now", x1: 0, x2: 0, y1: 0, y2: kHigh });
  out.append(now);
  out.addEventListener("click", event => {
    const box = out.getBoundingClientRect();
    seek(line.seconds * (event.clientX - box.left) / box.width);
  });
  return {
    element: el("div", { class: "line-frame" }, el("p", { class: "line-names", "aria-hidden": "true" },
      el("span", {}, say("force_axis", { n: number(most) })), line.nearest_mm ? el("span", {}, say("near_axis", { n: number(line.farthest_mm) })) : null), out),
    show(t) { now.setAttribute("x1", x(t)); now.setAttribute("x2", x(t)); },
  };
}

// What is under way at t: the step's title.
const step_at = (kit, line, t) => {
  const step = line.steps.findLast(one => one.from_s <= t && t <= one.to_s);
  return step ? kit.textOf(step.say, step.id) : "–";
};
const part_at = (values, line, t) => values?.[Math.min(values.length - 1, Math.floor(values.length * t / Math.max(1e-9, line.seconds)))] ?? null;

// Buttons and slider. length: of the slider; rate(at): how fast `at` goes, in its unit per second.
function player(kit, length, words, moved, rate = () => 1) {
  const { el, say } = kit;
  const play = el("button", { type: "button", class: "play" }, say("play"));
  const slider = el("input", { type: "range", min: 0, max: length, step: "any", value: 0, "aria-label": say("moment") });
  const speed = el("select", { "aria-label": say("speed") }, kSpeeds.map(each => el("option", { value: each, selected: each === 1 ? "" : null }, each + "×")));
  const out = { at: 0, element: el("div", { class: "row player" }, play, slider, speed) };
  let began = null;
  const stop = () => { began = null; play.textContent = say("play"); };
  const go = at => {
    out.at = Math.min(length, Math.max(0, at));
    slider.value = out.at;
    slider.setAttribute("aria-valuetext", words(out.at));
    moved(out.at);
  };
  const step = now => {
    if (began === null || !play.isConnected) return;
    go(out.at + Number(speed.value) * rate(out.at) * (now - began) / 1000);
    began = now;
    if (out.at >= length) stop();
    else requestAnimationFrame(step);
  };
  play.addEventListener("click", () => {
    if (began !== null) return stop();
    if (out.at >= length) go(0);
    play.textContent = say("hold");
    requestAnimationFrame(now => { began = now; step(now); });
  });
  slider.addEventListener("input", () => { stop(); go(Number(slider.value)); });
  out.go = at => { stop(); go(at); };
  return out;
}

// ---- the views

const head = (kit, session) => kit.el("p", {}, kit.link(kit.to("learner", session.learner), session.learner), ", ", session.case, ", ",
  kit.link(kit.to("session", session.id), kit.time(session.started_ms)));

export async function replay(kit, id, at) {
  const { el, say, ask, number, textOf, table } = kit;
  const session = await ask("session?" + new URLSearchParams({ id }));
  const scene = new Scene(kit), place = el("div"), waits = el("p", { role: "status" }, say("preparing"));
  const out = [el("h1", {}, say("replay") + " " + kit.time(session.started_ms)), head(kit, session), waits, place];
  line_of(kit, id, share => { waits.textContent = say("preparing") + " " + Math.round(100 * share) + " %"; }).then(line => {
    waits.remove();
    const lost = lost_of(session, line);
    const figures = el("p", { class: "figures" });
    const write = t => {
      figures.textContent = say("moment_words", { t: number(t, 4), of: number(line.seconds, 4), step: step_at(kit, line, t),
        force: number(part_at(line.force_n, line, t)), distance: number(part_at(line.nearest_mm, line, t)) });
    };
    const control = player(kit, line.seconds, t => number(t) + " s", t => { scene.seek(t); drawn.show(t); write(t); });
    const drawn = chart(kit, line, lost, control.go);
    const jump = (by, then = () => scene.look_at(null)) => {
      const times = by.sort((a, b) => a - b);
      return direction => {
        const next = direction > 0 ? times.find(t => t > control.at + 0.05) : times.findLast(t => t < control.at - 0.05);
        if (next === undefined) return;
        control.go(next);
        then(next);
      };
    };
    const button = (key, act) => {
      const one = el("button", { type: "button" }, say(key));
      one.addEventListener("click", act);
      return one;
    };
    const turn_to = t => scene.look_at(lost.find(one => Math.abs(one.at - t) < 0.05 && one.item.place_mm)?.item.place_mm ?? null);
    const to_lost = jump(lost.map(one => one.at), turn_to), to_step = jump(line.steps.map(step => step.from_s));
    const to_cut = jump(line.cutting.flatMap((cut, n) => cut && !line.cutting[n - 1] ? [n * line.seconds / line.cutting.length] : []));
    const jumps = [[lost.length, "lost_before", "lost_next", to_lost], [line.steps.length, "step_before", "step_next", to_step], [1, "cut_before", "cut_next", to_cut]]
      .flatMap(([there, before, next, act]) => there ? [button(before, () => act(-1)), button(next, () => act(1))] : []);
    place.append(scene.element, control.element, figures, drawn.element, el("div", { class: "row" }, jumps));
    place.append(el("h2", {}, say("lost_points")));
    const unmet = session.items.filter(item => item.result === "unmet");
    if (unmet.length === 0) place.append(el("p", {}, say("nothing_lost")));
    else place.append(table(say("lost_points"), [[say("item")], [say("value"), "number"], [say("threshold"), "number"], [say("evidence")]],
      unmet.map(item => [textOf(item.say, item.id), number(item.value), number(item.threshold), el("td", {}, lost.filter(one => one.item.id === item.id).map(one => {
        const go = el("button", { type: "button" }, one.at_end ? say("at_end") : number(one.at) + " s");
        go.addEventListener("click", () => {
          control.go(one.at);
          scene.look_at(one.item.place_mm ?? null);
          scene.canvas.scrollIntoView({ block: "nearest" });
        });
        return go;
      }), item.place_mm ? " " + say("evidence_place", { place: item.place_mm.map(value => number(value)).join("; ") }) : null)])));
    control.go(Number(at) || 0);
    if (at) turn_to(Number(at));
    scene.open(line);
  }).catch(trouble => {
    waits.textContent = trouble.message;
    waits.className = "wrong";
  });
  return out;
}

// The steps that both have, in the order of the first; none: the share of the time.
function pace_of(a, b) {
  const steps = [];
  for (const step of a.steps) {
    const other = b.steps.find(one => one.id === step.id);
    if (other && !steps.some(one => one.id === step.id)) steps.push({ id: step.id, say: step.say, spans: [step, other].map(one => [one.from_s, one.to_s]) });
  }
  if (steps.length === 0) return { steps: [], length: 1, time: (side, at) => at * (side ? b : a).seconds, rate: () => 1 / Math.max(1e-9, a.seconds, b.seconds) };
  const where = at => { const n = Math.min(steps.length - 1, Math.floor(at)); return [steps[n], at - n]; };
  return {
    steps,
    length: steps.length,
    time(side, at) { const [step, share] = where(at), [from, to] = step.spans[side]; return from + share * (to - from); },
    rate(at) { const [step] = where(at); return 1 / Math.max(0.1, ...step.spans.map(([from, to]) => to - from)); },
  };
}

export async function beside(kit, first, second) {
  const { el, say, ask, number, textOf, table } = kit;
  const ids = [first, second];
  const sessions = await Promise.all(ids.map(id => ask("session?" + new URLSearchParams({ id }))));
  const waits = el("p", { role: "status" }, say("preparing")), place = el("div");
  Promise.all(ids.map(id => line_of(kit, id, () => {}))).then(lines => {
    waits.remove();
    const pace = pace_of(...lines), scenes = [new Scene(kit), new Scene(kit)];
    const words = at => {
      const step = pace.steps[Math.min(pace.steps.length - 1, Math.floor(at))];
      return step ? textOf(step.say, step.id) : Math.round(100 * at) + " %";
    };
    const figures = lines.map(() => el("p", { class: "figures" }));
    const show = (side, t) => {
      scenes[side].seek(t);
      charts[side].show(t);
      figures[side].textContent = say("moment_words", { t: number(t, 4), of: number(lines[side].seconds, 4), step: step_at(kit, lines[side], t),
        force: number(part_at(lines[side].force_n, lines[side], t)), distance: number(part_at(lines[side].nearest_mm, lines[side], t)) });
    };
    const control = player(kit, pace.length, words, at => [0, 1].forEach(side => show(side, pace.time(side, at))), pace.rate);
    const charts = lines.map((line, side) => chart(kit, line, lost_of(sessions[side], line), t => show(side, t)));
    place.append(control.element, el("p", { class: "note" }, say(pace.steps.length ? "by_step" : "by_share")),
      el("div", { class: "two" }, [0, 1].map(side => el("section", { "aria-label": sessions[side].learner + ", " + kit.time(sessions[side].started_ms) + ", " + (side + 1) },
        head(kit, sessions[side]), scenes[side].element, figures[side], charts[side].element))));
    if (pace.steps.length) {
      const seconds = ([from, to]) => number(to - from) + " s";
      place.append(table(say("steps"), [[say("step")], [sessions[0].learner, "number"], [sessions[1].learner, "number"]], pace.steps.map((step, n) => {
        const go = el("button", { type: "button" }, textOf(step.say, step.id));
        go.addEventListener("click", () => control.go(n));
        return [go, seconds(step.spans[0]), seconds(step.spans[1])];
      })));
    }
    control.go(0);
    scenes[0].open(lines[0]);
    scenes[1].open(lines[1]);
  }).catch(trouble => {
    waits.textContent = trouble.message;
    waits.className = "wrong";
  });
  return [el("h1", {}, say("replay_beside")), waits, place];
}
