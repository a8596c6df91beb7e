// Marks by persons, how far they agree, and the centre's standards. A product to mark has a code drawn at random: nothing
// here knows whose it is, when it was made, or what the machine thinks of it.
import { ratingWords } from "./rating_words.mjs";

const again = 1500;  // [ms] between two looks whether pictures are drawn
const marks = ["met", "unmet", "not assessable"];

// tools: what the page itself uses (school.mjs). Returns the views by the first part of their address.
export function ratingViews({ words, say, textOf, time, number, el, link, to, table, facts, ask, post, query, tell }) {
  for (const [language, more] of Object.entries(ratingWords)) Object.assign(words[language], more);
  const percent = value => Math.round(100 * value) + " %";
  const two = value => value == null ? "–" : value.toFixed(2);
  const markWord = mark => say(mark === "not assessable" ? "cannot_judge" : mark);

  // ---- marking

  function picture(code, one, addresses) {
    const side = say("picture_" + one.name.replace(/-\d$/, "")), third = /-(\d)$/.exec(one.name)?.[1];
    const text = (third ? say("section_n", { plane: side, n: third }) : side) + ", " + say("wide", { mm: number(one.wide_mm, 2) });
    const image = el("img", { alt: text, width: one.width, height: one.height });
    ask("rating/picture" + query({ code, name: one.name })).then(blob => {
      const address = URL.createObjectURL(blob);
      addresses.push(address);
      image.src = address;
    }).catch(tell);
    return el("figure", {}, image, el("figcaption", {}, text));
  }

  // Draws the pictures into `place` as soon as they are there. Ends where the page went on.
  async function pictures(code, place, addresses) {
    for (let first = true; ; first = false) {
      const now = await ask("rating/product" + query({ code }));
      if (!first && !place.isConnected) return;
      if (!now.drawing) {
        const list = now.pictures.map(one => picture(code, one, addresses));
        return place.replaceChildren(...(now.trouble ? [el("p", { class: "note" }, now.trouble)] : list));
      }
      place.replaceChildren(el("p", { role: "status" }, say("drawing")));
      await new Promise(done => setTimeout(done, again));
      if (!place.isConnected) return;
    }
  }

  function question(item, number_) {
    const name = "item-" + number_;
    const choices = marks.map(mark => el("label", {}, el("input", { type: "radio", name, value: mark }), " " + markWord(mark)));
    const reason = el("input", { type: "text", maxlength: 300, "aria-label": say("reason") + ": " + textOf(item.say, item.id), placeholder: say("reason") });
    const group = el("fieldset", { "data-item": item.id }, el("legend", {}, textOf(item.say, item.id)), el("div", { class: "row" }, choices, reason));
    const chosen = () => group.querySelector("input:checked")?.value;
    return { group, chosen, mark: () => ({ item: item.id, mark: chosen(), reason: reason.value.trim() }) };
  }

  async function rate() {
    const name = el("input", { type: "text", id: "rater", maxlength: 60, autocomplete: "off", value: sessionStorage.getItem("burr-rater") ?? "" });
    const which = el("select", { id: "rating-rubric" }, el("option", { value: "" }, say("all_rubrics")));
    const start = el("button", { type: "submit" }, say("begin_marking"));
    const who = el("form", { class: "row" }, el("label", { for: "rater" }, say("you_are")), name, el("label", { for: "rating-rubric" }, say("rubric")), which, start);
    const place = el("div"), addresses = [];
    const clear = () => addresses.splice(0).forEach(address => URL.revokeObjectURL(address));

    async function fill() {
      const rater = name.value.trim();
      sessionStorage.setItem("burr-rater", rater);
      const queue = await post("rating/next", { rater, rubric: which.value });
      const chosen = which.value;
      which.replaceChildren(el("option", { value: "" }, say("all_rubrics")), ...queue.rubrics.map(one => el("option", { value: one.hash }, one.name + ", " + say("version", { n: one.version }))));
      which.value = chosen;
      clear();
      const out = [el("p", {}, say("left", { n: queue.left }) + (queue.elsewhere ? " " + say("elsewhere", { n: queue.elsewhere }) : ""))];
      if (queue.read_only) out.push(el("p", { class: "note" }, say("read_only")));
      if (queue.code == null) return place.replaceChildren(...out, el("p", {}, say("nothing_left")));
      const product = await ask("rating/product" + query({ code: queue.code }));
      const seen = el("div", { class: "pictures" }), heading = el("h2", { tabindex: -1 }, say("product_of", { name: product.case }));
      const questions = product.items.map(question);
      const keep = el("button", { type: "submit" }, say("keep_marks"));
      const form = el("form", { class: "marks" }, questions.map(one => one.group), el("div", { class: "row" }, keep));
      form.addEventListener("submit", async event => {
        event.preventDefault();
        const open = questions.filter(one => !one.chosen());
        if (open.length) {
          tell(new Error(say("marks_missing", { n: open.length })));
          return open[0].group.querySelector("input").focus();
        }
        keep.disabled = true;
        try {
          await post("rating/marks", { rater, code: queue.code, marks: questions.map(one => one.mark()) });
          await fill();
          place.querySelector("h2")?.focus();
          tell(null, say("kept"));
        } catch (trouble) {
          keep.disabled = false;
          tell(trouble);
        }
      });
      place.replaceChildren(...out, heading, seen, form);
      pictures(queue.code, seen, addresses).catch(tell);
    }

    who.addEventListener("submit", event => { event.preventDefault(); tell(null, ""); fill().catch(tell); });
    if (name.value) await fill();
    return [el("h1", {}, say("rate")), el("p", {}, say("rate_how")), who, place];
  }

  // ---- agreement

  const pairName = one => (one.first === "machine" ? say("machine") : one.first) + " – " + (one.second === "machine" ? say("machine") : one.second);
  const kappa = one => one.kappa == null ? "–" : two(one.kappa) + " (" + two(one.kappa_95[0]) + " … " + two(one.kappa_95[1]) + ")";

  function raters(all) {
    const of = all.raters.figures, out = [el("h2", {}, say("raters"))];
    if (!of) return [...out, el("p", { class: "note" }, say("few_products", { n: all.raters.products, of: all.raters.needed }))];
    const heads = [[say("item")], [say("raters")], [say("products"), "number"], [say("agreement"), "number"], ["κ (95 %)", "number"], ["AC1", "number"], [say("prevalence"), "number"]];
    const row = one => [one.item ? textOf(all.say[one.item], one.item) : say("all_items"), pairName(one), one.products, percent(one.agreement), kappa(one), two(one.ac1), two(one.prevalence)];
    const whole = of.pairs.filter(one => !one.item), items = of.pairs.filter(one => one.item);
    out.push(table(say("all_items"), heads, whole.map(row), "", true));
    out.push(el("p", {}, of.icc == null ? say("no_icc", { n: of.complete, of: all.raters.needed }) : say("icc", { n: of.complete, icc: two(of.icc) })));
    if (of.apart.length)
      out.push(table(say("totals_apart"), [[say("raters")], [say("mean_difference"), "number"], [say("limits"), "number"]],
        of.apart.map(one => [pairName(one), two(one.mean), two(one.limits[0]) + " … " + two(one.limits[1])]), "", true));
    if (of.ask_a_person.length) out.push(el("p", { class: "note" }, say("ask_a_person") + " " + of.ask_a_person.map(id => textOf(all.say[id], id)).join("; ")));
    out.push(el("h3", {}, say("by_item")), table(say("by_item"), heads, items.map(row)));
    return [...out, el("p", {}, say("kappa_note"))];
  }

  function reliability(one) {
    const out = [el("h3", {}, say(one.part))];
    if (!one.figures) return [...out, el("p", { class: "note" }, say("few_people", { n: one.people, of: one.fewest, marks: one.needed }))];
    out.push(table(say("reliability") + ", " + say(one.part), [[say("marks"), "number"], ["G", "number"], ["Φ", "number"], [say("standard_error"), "number"]],
      one.figures.of.map(row => [row.marks, two(row.g), two(row.phi), number(row.error, 3)])));
    out.push(el("p", {}, say("of_people", { n: one.people, marks: one.needed, low: two(one.figures.g_95[0]), high: two(one.figures.g_95[1]) })));
    out.push(el("p", { class: "note" }, one.figures.enough == null ? say("never_enough") : say("enough_marks", { n: one.figures.enough })));
    return out;
  }

  async function agreement(rubric = "") {
    const all = await ask("agreement" + query({ rubric }));
    const out = [el("h1", {}, say("agreement_title"))];
    if (!all.rubric) return [...out, el("p", {}, say("no_scores"))];
    const choose = el("select", { id: "agreement-rubric" }, all.rubrics.map(one => el("option", { value: one.hash }, one.name + ", " + say("version", { n: one.version }))));
    choose.value = all.rubric;
    choose.addEventListener("change", () => { location.hash = to("agreement", choose.value); });
    out.push(el("div", { class: "row" }, el("label", { for: "agreement-rubric" }, say("rubric")), choose), ...raters(all));
    out.push(el("h2", {}, say("reliability")), el("p", {}, say("reliability_what")), ...all.reliability.flatMap(reliability));
    return out;
  }

  // ---- standards

  const decision = one => one.outcome == null ? "–" : say("outcome_" + one.outcome) + ", " + one.confirmed_by + ", " + time(one.decided_ms);
  function proposed(one) {
    return one.reached ? say("reached", { a: one.first, b: one.first + 1 }) : say("not_reached");
  }

  async function standards() {
    const all = await ask("standards");
    const out = [el("h1", {}, say("standards"))];
    if (all.standards.length === 0) return [...out, el("p", {}, say("no_standard"))];
    out.push(el("p", {}, say("standards_what")));
    for (const one of all.standards) {
      const people = one.judges != null ? say("judges", { n: one.judges }) : say("groups", { low: one.n_low, high: one.n_high });
      out.push(el("h2", {}, one.rubric + ", " + say(one.part)));
      out.push(facts([[say("cut"), say("points", { n: number(one.cut, 3) })], [say("method"), (one.method === "contrasting groups" ? say("contrasting") : one.method) + ", " + people],
        ...(one.false_pass == null ? [] : [[say("false_marks"), say("false_shares", { pass: percent(one.false_pass), fail: percent(one.false_fail) })]]),
        [say("set_by"), one.set_by + ", " + time(one.made_ms)], [say("remark"), one.text || "–"], [say("standard_id"), one.id]]));
      if (one.learners.length === 0) { out.push(el("p", {}, say("no_sessions"))); continue; }
      out.push(table(say("proposals"), [[say("learner")], [say("unguided"), "number"], [say("proposal")], [say("decision")]],
        one.learners.map(row => [link(to("learner", row.learner), row.learner), row.sessions < all.needed ? say("of_five", { n: row.sessions, of: all.needed }) : String(row.sessions), proposed(row), decision(row)]), "", true));
    }
    return out;
  }

  return { rate, agreement, standards };
}
