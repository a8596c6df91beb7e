// The instructor's page: what the store says, as tables and one kind of chart. Texts of people enter the page as text
// nodes only, never as markup. The token comes in the part of the address after '#' and stays in this tab.
import { ratingViews } from "./rating.mjs";
import { words } from "./words.mjs";
import { live } from "./live.mjs";
import { beside, replay } from "./replay.mjs";

const needed = 5;  // sessions without guidance before a figure means something
const idleDays = 14;

// ---- words

let language = localStorage.getItem("burr-language") ?? navigator.language.slice(0, 2);
if (!words[language]) language = "en";

function say(key, values = {}) {
  return words[language][key].replace(/\{(\w+)\}/g, (_, name) => String(values[name] ?? ""));
}
const textOf = (texts, id) => texts?.[language] || texts?.en || id;
const day = ms => ms == null ? say("not_yet") : new Date(ms).toLocaleDateString(language, { dateStyle: "medium" });
const time = ms => new Date(ms).toLocaleString(language, { dateStyle: "medium", timeStyle: "short" });
const dateOf = text => new Date(text + "T12:00").toLocaleDateString(language, { dateStyle: "medium" });  // "2026-12-03"
const number = (value, digits = 3) => value == null ? "–" : typeof value === "string" ? value : Number(value.toPrecision(digits)).toLocaleString(language);

// ---- elements

function el(name, attributes = {}, ...children) {
  const svg = ["svg", "path", "circle", "line", "polygon", "text", "title"].includes(name);
  const out = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) if (value != null) out.setAttribute(key, value);
  out.append(...children.flat().filter(child => child != null).map(child => child instanceof Node ? child : String(child)));
  return out;
}
const link = (to, ...children) => el("a", { href: "#" + to }, ...children);
const to = (...parts) => "/" + parts.map(encodeURIComponent).join("/");

// seen: false where the heading above says the same; the caption is then for screen readers alone.
function table(caption, heads, rows, kind = "", seen = false) {
  const head = el("tr", {}, heads.map(([text, what]) => el("th", { scope: "col", class: what ?? null }, text)));
  const body = rows.map(cells => el("tr", {}, cells.map((cell, n) => {
    const what = heads[n][1] ?? null;
    return n === 0 ? el("th", { scope: "row" }, cell) : cell instanceof Element && cell.tagName === "TD" ? cell : el("td", { class: what }, cell);
  })));
  return el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": caption },
    el("table", { class: kind || null }, el("caption", { class: seen ? null : "hidden" }, caption), el("thead", {}, head), el("tbody", {}, body)));
}
function facts(pairs) {
  return el("dl", { class: "facts" }, pairs.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)]));
}

// ---- the server

function takeToken() {
  const found = /(?:^#|&)token=([^&]+)/.exec(location.hash);
  if (!found) return;
  sessionStorage.setItem("burr-token", decodeURIComponent(found[1]));
  history.replaceState(null, "", location.pathname + "#/");
}
async function raw(path, body) {
  let answer;
  const headers = { Authorization: "Bearer " + (sessionStorage.getItem("burr-token") ?? "") };
  if (body !== undefined) headers["Content-Type"] = "application/json";
  try {
    answer = await fetch("/api/" + path, body === undefined ? { headers } : { method: "POST", headers, body: JSON.stringify(body) });
  } catch {
    throw new Error(say("gone"));
  }
  if (answer.status === 401) throw new Error(say("token"));
  return answer;
}
// body: posted as JSON; none: asked for.
async function ask(path, body) {
  const answer = await raw(path, body);
  const type = answer.headers.get("Content-Type") ?? "";
  if (!type.startsWith("application/json")) return answer.blob();
  const out = await answer.json();
  if (!answer.ok) throw new Error(out.error);
  return out;
}
const query = values => "?" + new URLSearchParams(values);

// ---- views

// When to practise again: a proposal, none where there are too few sessions.
const again = one => one?.next ? dateOf(one.next.day) : "–";
const againMost = one => !one.next ? "–" : one.next.sessions === 1 ? say("again_one") : say("again_most", { n: one.next.sessions });
function againWords(one) {
  if (!one.next) return say("again_few", { n: one.finished, of: one.needed });
  return say("trend_" + one.next.trend) + (one.next.other_bone ? " " + say("again_other") : "");
}
const againFrom = one => !one.next ? "–" : one.next.due ? say("again_due", { day: again(one) }) : again(one);

const sessionsWord = n => n < needed ? say("of_five", { n, of: needed }) : String(n);

async function overview() {
  const all = await ask("overview");
  const out = [el("h1", {}, say("overview"))];
  if (all.read_only) out.push(el("p", { class: "note" }, say("read_only")));
  out.push(...all.notices.map(notice => el("p", { class: "note" }, notice)));
  const old = Date.now() - idleDays * 864e5;
  const idle = all.learners.filter(one => one.last_ms == null || one.last_ms < old);
  const guided = all.learners.filter(one => one.sessions >= needed && one.unguided === 0);
  const names = list => list.length === 0 ? [say("nobody")] : list.slice(0, 12).flatMap((one, n) => [n ? ", " : "", link(to("learner", one.id), one.id)])
    .concat(list.length > 12 ? [", " + say("one_more", { n: list.length - 12 })] : []);
  const due = all.learners.filter(one => one.practice?.next?.due).sort((a, b) => a.practice.next.day < b.practice.next.day ? -1 : 1);
  out.push(facts([[say("due"), el("span", { id: "due" }, names(due))], [say("idle"), el("span", {}, names(idle))], [say("guided_long"), el("span", {}, names(guided))]]));
  if (all.cohorts.length) {
    out.push(el("h2", {}, say("cohorts")));
    out.push(table(say("cohorts"), [[say("cohort")], [say("people"), "number"], [say("case")]], all.cohorts.map(one => [
      one.title, one.members,
      el("td", {}, all.cases.flatMap((name, n) => [n ? ", " : "", link(to("cohort", one.id, name), name)]))])));
  }
  out.push(el("h2", {}, say("learners")));
  out.push(table(say("learners"), [[say("learner")], [say("level")], [say("sessions"), "number"], [say("unguided"), "number"], [say("last")], [say("again")]],
    all.learners.map(one => [link(to("learner", one.id), one.id), one.level || "–", one.sessions, sessionsWord(one.unguided), day(one.last_ms), again(one.practice)])));
  out.push(el("p", {}, say("again_note")));
  return out;
}

// A share as colour, sign and number.
function share(met, of) {
  if (!of) return ["none", "–"];
  const part = met / of;
  return [part >= 0.8 ? "good" : part >= 0.4 ? "half" : "bad", met + "/" + of];
}

// Who of a cohort is due at this case: the earliest first.
function practised(all) {
  if (all.practice.length === 0) return [];
  const rows = [...all.practice].sort((a, b) => (a.next?.day ?? "9") < (b.next?.day ?? "9") ? -1 : 1);
  return [el("h2", {}, say("again")), el("p", {}, say("again_note")),
    table(say("again"), [[say("learner")], [say("sessions"), "number"], [say("last")], [say("again_from")], [say("again_how_many")], [say("again_why")]],
      rows.map(one => [link(to("learner", one.learner), one.learner), one.finished, dateOf(one.last_day), againFrom(one), againMost(one), againWords(one)]), "again")];
}

async function cohort(id, name) {
  const all = await ask("cohort" + query({ id, case: name }));
  const caption = say("heat", { n: needed });
  const out = [el("h1", {}, say("cohort") + " " + all.title + ", " + name)];
  if (all.items.length === 0) return [...out, el("p", {}, say("no_sessions")), ...practised(all)];
  const cells = new Map(all.cells.map(one => [one.learner + "\n" + one.item, one]));
  const rows = all.members.map(learner => [link(to("learner", learner), learner), ...all.items.map(item => {
    const cell = cells.get(learner + "\n" + item.id);
    const [kind, text] = share(cell?.met ?? 0, cell?.assessable ?? 0);
    return el("td", { class: kind }, text, cell ? null : el("span", { class: "hidden" }, " " + say("no_sessions")));
  })]);
  if (all.shares.some(one => one.share != null))
    rows.push([say("all_of_them"), ...all.items.map(item => {
      const one = all.shares.find(s => s.item === item.id);
      if (one?.share == null) return el("td", { class: "none" }, "–");
      return el("td", { class: share(one.share, 1)[0] }, Math.round(100 * one.share) + " %");
    })]);
  out.push(table(caption, [[say("learner")], ...all.items.map(item => [textOf(item.say, item.id)])], rows, "heat", true));
  if (all.members.length < needed) out.push(el("p", {}, say("heat_few", { n: needed })));
  return [...out, ...practised(all)];
}

// Marks over attempts, 0 to 100 %.
function chart(points, curve, title) {
  const wide = 640, high = 270, left = 44, top = 26, right = 14, bottom = 34;
  const last = Math.max(needed, ...points.map(one => one.attempt));
  const x = n => left + (wide - left - right) * (n - 0.5) / last, y = value => top + (high - top - bottom) * (1 - Math.min(100, Math.max(0, value)) / 100);
  const parts = [el("title", {}, title)];
  for (const value of [0, 25, 50, 75, 100])
    parts.push(el("line", { class: "axis", x1: left, x2: wide - right, y1: y(value), y2: y(value) }), el("text", { x: left - 6, y: y(value) + 4, "text-anchor": "end" }, value));
  for (let n = 1; n <= last; n += Math.ceil(last / 12)) parts.push(el("text", { x: x(n), y: high - bottom + 16, "text-anchor": "middle" }, n));
  parts.push(el("text", { x: (wide + left) / 2, y: high - 4, "text-anchor": "middle" }, say("attempts")), el("text", { x: 4, y: 11 }, say("share_met")));
  if (curve?.band) {
    const up = curve.band.map(([low, upper], n) => [x(n + 1), y(upper)]), down = curve.band.map(([low], n) => [x(n + 1), y(low)]).reverse();
    parts.push(el("polygon", { class: "band", points: [...up, ...down].map(p => p.map(v => v.toFixed(1)).join(",")).join(" ") }));
    parts.push(el("path", { class: "line", d: curve.line.map((value, n) => (n ? "L" : "M") + x(n + 1).toFixed(1) + " " + y(value).toFixed(1)).join(" ") }));
  }
  for (const one of points) {
    const what = el("title", {}, one.attempt + ": " + Math.round(one.value) + " %, " + say(one.guided ? "guided" : "free_of_help") + (one.finished ? "" : ", " + say("unfinished")));
    if (!one.finished) {
      const [u, v] = [x(one.attempt), y(one.value)];
      parts.push(el("path", { class: "broken", d: `M${u - 4} ${v - 4}L${u + 4} ${v + 4}M${u - 4} ${v + 4}L${u + 4} ${v - 4}` }, what));
      continue;
    }
    parts.push(el("circle", { class: one.guided ? "guided" : "free", cx: x(one.attempt), cy: y(one.value), r: 4.5 }, what));
  }
  return el("svg", { class: "curve", viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": title }, parts);
}

const part = (session, which) => session.parts[which];
const metOf = one => one ? one.met + "/" + one.assessable : "–";

async function learner(id) {
  const all = await ask("learner" + query({ id }));
  const out = [el("h1", {}, say("learner") + " " + all.id)];
  out.push(facts([[say("level"), all.level || "–"], [say("sessions"), all.sessions.length]]));
  for (const one of all.cases) {
    out.push(el("h2", {}, one.name));
    for (const which of ["product", "process"]) {
      const points = one.points.filter(p => p[which] != null).map(p => ({ attempt: p.attempt, guided: p.guided, finished: p.finished, value: 100 * p[which] }));
      if (points.length === 0) continue;
      const curve = one.curves[which], title = say(which) + ": " + say("curve");
      out.push(el("h3", {}, title), chart(points, curve, title));
      out.push(el("p", {}, !curve ? say("no_curve") : curve.n90 == null ? say("falling") : say("plateau", { a: Math.round(curve.a), n: number(curve.n90, 2) })));
    }
    out.push(el("p", {}, say("legend")));
    const next = all.practice.find(p => p.case === one.name);
    if (next) out.push(el("p", { class: "again" }, el("strong", {}, say("again") + ": "), next.next ? againFrom(next) + ", " + againMost(next) + ". " + againWords(next) + " " + say("again_note") : againWords(next)));
    if (one.unguided < needed) out.push(el("p", { class: "note" }, say("no_decision")));
  }
  out.push(el("h2", {}, say("sessions")));
  out.push(table(say("sessions"), [[say("started")], [say("case")], [say("attempt"), "number"], [say("mode")], [say("duration"), "number"], [say("product"), "number"], [say("process"), "number"], [say("gates"), "number"]],
    all.sessions.map(one => [link(to("session", one.id), time(one.started_ms)), one.case, one.attempt, one.mode + ", " + say(one.guided ? "guided" : "free_of_help") + (one.finished ? "" : ", " + say("unfinished")) + ", " + say(one.sealed ? "sealed" : "unsealed"),
      say("minutes", { n: number(one.seconds / 60) }), metOf(part(one, "product")), metOf(part(one, "process")), part(one, "product") ? (part(one, "product").gates + (part(one, "process")?.gates ?? 0)) : "–"])));
  return out;
}

const signs = { met: "✓", unmet: "✗", "too early": "○", "not assessable": "–" };
const kinds = { met: "good", unmet: "bad", "too early": "early", "not assessable": "none" };
const resultWord = result => (signs[result] ?? "") + " " + say(result.replace(" ", "_"));

function evidence(item, session) {
  const times = item.evidence ?? [];
  if (times.length === 0) return item.place_mm ? say("evidence_place", { place: item.place_mm.map(x => number(x)).join("; ") }) : "–";
  return el("td", {}, times.slice(0, 5).flatMap((t, n) => [n ? ", " : null, link(to("replay", session, t), say("evidence_at", { t: number(t) }))]), times.length > 5 ? ", " + say("one_more", { n: times.length - 5 }) : null);
}

async function session(id) {
  const all = await ask("session" + query({ id }));
  const out = [el("h1", {}, say("session") + " " + time(all.started_ms))];
  out.push(facts([[say("learner"), link(to("learner", all.learner), all.learner)], [say("case"), all.case], [say("attempt"), all.attempt],
    [say("mode"), all.mode + ", " + say(all.guided ? "guided" : "free_of_help") + ", " + say(all.finished ? "finished" : "unfinished") + ", " + say(all.sealed ? "sealed" : "unsealed")],
    [say("duration"), say("minutes", { n: number(all.seconds / 60) })], [say("device"), all.device || "–"], [say("voxel"), number(all.voxel_um) + " µm"],
    [say("recording"), all.recording]]));
  out.push(el("p", {}, link(to("replay", id), say("replay"))));
  if (all.calibrated < all.items.length) out.push(el("p", { class: "note" }, say("default_note", { n: all.calibrated, of: all.items.length })));
  for (const which of ["product", "process"]) {
    // what did harm comes first
    const items = all.items.filter(item => item.part === which).sort((a, b) => Number(b.harm ?? false) - Number(a.harm ?? false));
    if (items.length === 0) continue;
    out.push(el("h2", {}, say(which)));
    out.push(table(say(which), [[say("item")], [say("result")], [say("value"), "number"], [say("threshold"), "number"], [say("self")], [say("evidence")]],
      items.map(item => [textOf(item.say, item.id), el("td", { class: kinds[item.result] ?? null }, resultWord(item.result)), number(item.value), number(item.threshold), item.self ? say(item.self === "unknown" ? "none" : item.self) : "–", evidence(item, id)])));
  }
  const others = all.others;
  if (others.length) {
    const choose = el("select", { id: "other" }, others.map(one => el("option", { value: one.id }, time(one.started_ms) + (one.learner === all.learner ? "" : ", " + one.learner))));
    const go = el("button", { type: "button" }, say("compare"));
    go.addEventListener("click", () => { location.hash = to("compare", id, choose.value); });
    out.push(el("div", { class: "row" }, el("label", { for: "other" }, say("beside")), choose, go));
  }
  return out;
}

async function compare(a, b) {
  const [first, second] = await Promise.all([ask("session" + query({ id: a })), ask("session" + query({ id: b }))]);
  const name = one => one.learner + ", " + time(one.started_ms);
  const out = [el("h1", {}, say("compare"))];
  const other = new Map(second.items.map(item => [item.id, item]));
  const tick = el("input", { type: "checkbox", id: "differs" });
  const place = el("div");
  const draw = () => place.replaceChildren(table(say("compare"), [[say("item")], [name(first)], [name(second)]],
    first.items.filter(item => !tick.checked || item.result !== other.get(item.id)?.result).map(item => {
      const beside = other.get(item.id), cell = one => el("td", { class: kinds[one?.result] ?? "none" }, one ? resultWord(one.result) + (one.value == null ? "" : " (" + number(one.value) + ")") : "–");
      return [textOf(item.say, item.id), cell(item), cell(beside)];
    })));
  tick.addEventListener("change", draw);
  draw();
  out.push(el("p", {}, link(to("session", a), name(first)), " · ", link(to("session", b), name(second)), " · ", link(to("beside", a, b), say("replay_beside"))), el("div", { class: "row" }, el("label", {}, tick, " " + say("differs"))), place);
  return out;
}

async function audit() {
  const all = await ask("audit");
  return [el("h1", {}, say("audit")), table(say("audit"), [[say("when")], [say("who")], [say("what")], [say("about")]], all.rows.map(one => [time(one.ms), one.who, one.what, one.subject || "–"]))];
}

async function download() {
  const blob = await ask("sessions.csv");
  const address = URL.createObjectURL(blob);
  const anchor = el("a", { href: address, download: "sessions.csv" });
  anchor.click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

// ---- the frame

// A sentence in the line of state; trouble: an Error, or null.
function tell(trouble, text = "") {
  if (trouble) return wrong(trouble);
  const state = document.getElementById("state");
  state.className = "";
  state.textContent = text;
}

// what the views in other files need
const kit = { words, el, say, ask, post: ask, raw, query, tell, link, to, number, time, textOf, table, facts, language: () => language };
const views = { "": overview, cohort, learner, session, compare, audit, live: name => live(kit, name),
  replay: (id, at) => replay(kit, id, at), beside: (first, second) => beside(kit, first, second), ...ratingViews(kit) };

function frame() {
  document.documentElement.lang = language;
  document.getElementById("skip").textContent = say("skip");
  document.getElementById("language-label").textContent = say("language") + " ";
  document.getElementById("language").value = language;
  document.getElementById("foot").textContent = say("foot");
  const here = location.hash.replace(/^#/, "") || "/";
  const entry = (path, key) => el("a", { href: "#" + path, "aria-current": here === path ? "page" : null }, say(key));
  const csv = el("a", { href: "#" + here }, say("csv"));
  csv.addEventListener("click", event => { event.preventDefault(); download().catch(wrong); });
  document.getElementById("nav").replaceChildren(entry("/", "overview"), entry("/live", "stations"), entry("/rate", "rate"), entry("/agreement", "agreement_title"),
    entry("/standards", "standards"), entry("/audit", "audit"), csv);
}
function wrong(trouble) {
  const state = document.getElementById("state");
  state.className = "wrong";
  state.textContent = trouble.message;
}

let turn = 0;
async function show(focus) {
  const mine = ++turn, main = document.getElementById("main"), state = document.getElementById("state");
  frame();
  state.className = "";
  state.textContent = say("loading");
  const began = performance.now();
  try {
    const [name, ...given] = location.hash.replace(/^#\/?/, "").split("/").map(decodeURIComponent);
    const content = await (views[name] ?? overview)(...given);
    if (mine !== turn) return;  // somebody went on meanwhile
    main.replaceChildren(...content);
    document.title = "burr – " + (main.querySelector("h1")?.textContent ?? "");
    state.textContent = "";
    document.body.dataset.shown = String(Math.round(performance.now() - began));
    if (focus) {
      main.focus({ preventScroll: true });
      scrollTo(0, 0);
    }
  } catch (trouble) {
    if (mine !== turn) return;
    main.replaceChildren();
    wrong(trouble);
  }
}

document.getElementById("language").addEventListener("change", event => {
  language = event.target.value;
  localStorage.setItem("burr-language", language);
  show(false);
});
document.getElementById("skip").addEventListener("click", event => { event.preventDefault(); document.getElementById("main").focus(); });
addEventListener("hashchange", () => { takeToken(); show(true); });
takeToken();
show(false);
