#include "python_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <iterator>
#include <mutex>
#include <set>
#include <span>
#include <thread>
#include <utility>

#include "burr/scoring/step_done.h"
#include "burr/tool/burr_tool.h"
#include "burr/workshop/label_check.h"

namespace burr::python {
namespace {

using namespace py::literals;

constexpr const char* kNames[] = {"touch", "leave", "removed", "near", "step_reached"};
constexpr auto kRest = std::chrono::microseconds(16'667);  // between two rounds of calls
constexpr auto kLook = std::chrono::milliseconds(50);      // for Ctrl-C
constexpr std::uint64_t kLookTicks = 1000;                 // between two looks at the steps

const char* name_of(Happens what) { return kNames[static_cast<int>(what)]; }

void merge(Event& into, const Event& more) {
  into.tick = more.tick;
  into.p = more.p;
  into.count += more.count;
  for (const auto& one : more.voxels) into.voxels[one.first] += one.second;
  if (more.distance_m)
    into.distance_m = std::min(into.distance_m.value_or(*more.distance_m), *more.distance_m);
}

volume::TissueId tissue_named(const volume::Bone& bone, const std::string& name) {
  std::string list;
  const auto& tissues = bone.tissues().tissues;
  for (std::size_t id = 1; id < tissues.size(); ++id) {
    if (tissues[id].name == name) return static_cast<volume::TissueId>(id);
    list += (list.empty() ? "" : ", ") + tissues[id].name;
  }
  raise(fmt::format("this bone has no tissue \"{}\"; it has {}", name, list));
}

std::string text_or_empty(const py::object& given) {
  return given.is_none() ? std::string() : given.cast<std::string>();
}

}  // namespace

Wanted wanted_of(const std::string& event, const py::object& call, const py::object& label,
                 const py::object& structure, const py::object& mm, const py::object& step) {
  const auto* const known = std::find_if(std::begin(kNames), std::end(kNames),
                                         [&](const char* name) { return event == name; });
  if (known == std::end(kNames))
    raise(fmt::format("event \"{}\" is not known; use touch, leave, removed, near or step_reached",
                      event));
  if (PyCallable_Check(call.ptr()) == 0) raise("give a function that takes an event");
  Wanted wanted{static_cast<Happens>(known - std::begin(kNames)), {}, 0, call};
  const auto only = [&](const char* name, const py::object& given, Happens what) {
    if (!given.is_none() && wanted.what != what)
      raise(fmt::format("{} belongs to the event \"{}\"", name, name_of(what)));
  };
  only("label", label, Happens::removed);
  only("structure", structure, Happens::near);
  only("mm", mm, Happens::near);
  only("step", step, Happens::step_reached);
  if (wanted.what == Happens::removed) wanted.name = text_or_empty(label);
  if (wanted.what == Happens::step_reached) wanted.name = text_or_empty(step);
  if (wanted.what != Happens::near) return wanted;
  if (structure.is_none() || mm.is_none())
    raise("near needs a structure and a distance: on(\"near\", f, structure=\"pulp\", mm=1)");
  wanted.name = text_or_empty(structure);
  wanted.mm = mm.cast<double>();
  if (!(wanted.mm > 0 && wanted.mm <= 20))
    raise(fmt::format("a distance of {} mm is not possible; use above 0 to 20", wanted.mm));
  return wanted;
}

// What the thread of the ticks, the helper thread and Python share. Python's functions are touched
// with the GIL alone; whoever holds `mutex` never waits for the GIL.
struct Events::Helper {
  using Key = std::pair<std::size_t, std::string>;  // the wish, and what of it happened
  std::mutex mutex;
  std::condition_variable wake;
  std::map<Key, Event> waiting;
  std::vector<py::object> calls;  // None: it raised, and is not called again
  std::optional<py::error_already_set> failed;
  std::string failed_event;
  bool ending = false, ended = false, quiet = false;
  std::thread thread;

  // steps: the newest bone that nobody has looked at
  std::unique_ptr<volume::Bone> now;
  std::uint64_t now_tick = 0;
  BonePtr before;
  const scenario::CaseLesson* lesson = nullptr;
  std::vector<std::pair<std::size_t, const scenario::Step*>> steps;  // not reached yet

  void run();
  void look_at_steps(std::unique_lock<std::mutex>& lock);
  void tell(const std::map<Key, Event>& batch);
  void stop(bool tell_rest);
};

void Events::Helper::run() {
  std::unique_lock lock(mutex);
  for (;;) {
    wake.wait(lock, [this] { return ending || now || !waiting.empty(); });
    if (quiet) break;
    if (now) look_at_steps(lock);
    const std::map<Key, Event> batch = std::exchange(waiting, {});
    if (batch.empty() && ending && !now) break;
    if (!batch.empty()) {
      lock.unlock();
      tell(batch);
      lock.lock();
    }
    // what happens now waits for the next round
    wake.wait_for(lock, kRest, [this] { return ending; });
  }
  ended = true;
  wake.notify_all();
}

void Events::Helper::look_at_steps(std::unique_lock<std::mutex>& lock) {
  const std::unique_ptr<volume::Bone> bone = std::move(now);
  const std::uint64_t tick = now_tick;
  auto open = steps;
  std::set<const scenario::Step*> reached;
  lock.unlock();
  NoProgress quiet_progress;
  std::map<const scenario::Step*, bool> known;
  for (const auto& one : open) {
    if (known.contains(one.second)) continue;
    const auto done =
        scoring::step_done(*one.second, *lesson, *before->bone, *bone, quiet_progress);
    known[one.second] = done && *done;
  }
  lock.lock();
  for (const auto& one : open) {
    if (!known[one.second]) continue;
    Event event;
    event.what = name_of(Happens::step_reached);
    event.step = one.second->id;
    event.first_tick = event.tick = tick;
    event.count = 1;
    waiting.emplace(Key{one.first, event.step}, event);
    std::erase(steps, one);
  }
}

void Events::Helper::tell(const std::map<Key, Event>& batch) {
  const py::gil_scoped_acquire mine;
  for (const auto& one : batch) {
    py::object call;
    {
      const std::lock_guard lock(mutex);
      if (quiet) return;
      call = calls[one.first.first];
    }
    if (call.is_none()) continue;
    try {
      call(one.second);
    } catch (py::error_already_set& raised) {
      if (one.first.first < calls.size()) calls[one.first.first] = py::none();
      const std::lock_guard lock(mutex);
      if (failed) continue;
      failed.emplace(raised);
      failed_event = one.second.what;
    }
  }
}

// GIL. tell_rest: false: what waits is dropped.
void Events::Helper::stop(bool tell_rest) {
  {
    const std::lock_guard lock(mutex);
    ending = true;
    quiet = quiet || !tell_rest;
  }
  wake.notify_all();
  if (!thread.joinable()) return;
  if (thread.get_id() == std::this_thread::get_id()) return thread.detach();
  const auto done = [this] {
    const py::gil_scoped_release others_may;
    std::unique_lock lock(mutex);
    return wake.wait_for(lock, kLook, [this] { return ended; });
  };
  while (!done())
    if (tell_rest && PyErr_CheckSignals() != 0) {  // Ctrl-C: the rest is not told
      const std::lock_guard lock(mutex);
      quiet = true;
      throw py::error_already_set();
    }
  const py::gil_scoped_release others_may;
  thread.join();
}

Events::Events(BonePtr bone, std::optional<scenario::Case> work)
    : bone_(std::move(bone)), work_(std::move(work)), helper_(std::make_shared<Helper>()) {
  helper_->before = bone_;
  // what still runs when Python ends could not take the GIL any more
  at_exit_ = py::cpp_function([left = std::weak_ptr<Helper>(helper_)] {
    if (const auto helper = left.lock()) helper->stop(false);
  });
  py::module_::import("atexit").attr("register")(at_exit_);
}

Events::~Events() {
  try {
    stop(false);
  } catch (py::error_already_set&) {  // stop(false) calls no Python function: not reached
  }
  forget();
}

void Events::add(Wanted wanted, bool keeps_voxels) {
  const std::size_t which = wanted_.size();
  const volume::Bone& bone = *bone_->bone;
  if (wanted.what == Happens::removed) {
    if (!keeps_voxels) raise("this session keeps no voxels; make it with voxels=True");
    removed_[wanted.name.empty() ? -1 : tissue_named(bone, wanted.name)].push_back(which);
  } else if (wanted.what == Happens::near) {
    const volume::TissueId tissue = tissue_named(bone, wanted.name);
    volume::DistanceSettings settings;
    settings.reach = 1e-3 * wanted.mm + 0.5 * tool::kLargestDiameter + 2 * bone.grid().voxel;
    Work work;
    auto to = take(work.run(
        [&] { return volume::DistanceTo::make(bone, std::span(&tissue, 1), settings, work); }));
    near_.push_back({which, 1e-3 * wanted.mm, std::move(to)});
  } else if (wanted.what == Happens::step_reached) {
    if (!work_) raise("only a case has steps; make the scene from a case");
    if (!lesson_) {
      lesson_ = take(workshop::placed_lesson(*work_));
      check(scoring::check_done(*lesson_, work_->name + ".toml"));
    }
    std::string list;
    bool found = false;
    for (const scenario::Step& step : lesson_->steps) {
      if (!step.done) continue;
      list += (list.empty() ? "" : ", ") + step.id;
      if (!wanted.name.empty() && step.id != wanted.name) continue;
      found = true;
      const std::lock_guard lock(helper_->mutex);
      helper_->lesson = &*lesson_;
      helper_->steps.emplace_back(which, &step);
    }
    if (!found)
      raise(list.empty() ? "no step of this case says when it is done (docs/use/cases.md)"
                         : fmt::format("this case has no step \"{}\" that says when it is done; "
                                       "it has {}",
                                       wanted.name, list));
    steps_.push_back(which);
  } else {
    (wanted.what == Happens::touch ? touch_ : leave_).push_back(which);
  }
  helper_->calls.push_back(std::exchange(wanted.call, py::none()));
  wanted_.push_back(std::move(wanted));
  if (!helper_->thread.joinable())
    helper_->thread = std::thread([helper = helper_] { helper->run(); });
}

void Events::put(std::size_t which, const std::string& name, const Event& event) {
  {
    const std::lock_guard lock(helper_->mutex);
    const auto [at, fresh] = helper_->waiting.try_emplace({which, name}, event);
    if (!fresh) merge(at->second, event);
  }
  helper_->wake.notify_one();
}

void Events::happened(std::size_t which, const std::string& name, const tick::TickRow& row,
                      std::optional<double> distance) {
  Event event;
  event.what = name_of(wanted_[which].what);
  event.first_tick = event.tick = row.tick;
  event.count = 1;
  event.p = row.contact.proxy;
  event.distance_m = distance;
  if (wanted_[which].what == Happens::near) event.structure = wanted_[which].name;
  put(which, name, event);
}

void Events::note(const tick::TickRow& row) {
  newest_ = row;
  if (row.contact.touching != touching_) {
    touching_ = row.contact.touching;
    for (const std::size_t which : touching_ ? touch_ : leave_) happened(which, {}, row, {});
  }
  for (Near& one : near_) {
    const double distance = one.to.at(row.contact.proxy).distance - row.tool.radius;
    const bool inside = distance < one.distance;
    if (inside && !one.inside) happened(one.which, {}, row, distance);
    one.inside = inside;
  }
}

void Events::note(const sim::CrossedVoxel& voxel) {
  if (!voxel.out || removed_.empty()) return;
  const int tissue = bone_->bone->tissue(voxel.i, voxel.j, voxel.k);
  for (const int key : {-1, tissue}) {
    const auto found = removed_.find(key);
    if (found == removed_.end()) continue;
    Event event;
    event.what = name_of(Happens::removed);
    event.first_tick = event.tick = voxel.tick;
    event.count = 1;
    event.p = newest_.contact.proxy;
    event.voxels[bone_->bone->tissues()[static_cast<volume::TissueId>(tissue)].name] = 1;
    for (const std::size_t which : found->second) put(which, {}, event);
  }
}

bool Events::wants_bone(std::uint64_t ticks) const {
  return !steps_.empty() && ticks >= looked_ + kLookTicks;
}

void Events::look(std::unique_ptr<volume::Bone> now, std::uint64_t tick) {
  looked_ = tick;
  {
    const std::lock_guard lock(helper_->mutex);
    helper_->now = std::move(now);
    helper_->now_tick = tick;
  }
  helper_->wake.notify_one();
}

void Events::start_over() {
  touching_ = false;
  for (Near& one : near_) one.inside = false;
  newest_ = {};
  looked_ = 0;
  if (!lesson_) return;
  const std::lock_guard lock(helper_->mutex);
  helper_->now.reset();
  helper_->steps.clear();
  for (const std::size_t which : steps_)
    for (const scenario::Step& step : lesson_->steps)
      if (step.done && (wanted_[which].name.empty() || wanted_[which].name == step.id))
        helper_->steps.emplace_back(which, &step);
}

void Events::raise_what_failed() {
  std::optional<py::error_already_set> failed;
  std::string event;
  {
    const std::lock_guard lock(helper_->mutex);
    failed.swap(helper_->failed);
    event = helper_->failed_event;
  }
  if (!failed) return;
  const std::string why = py::str(failed->value());
  const std::string type = py::str(failed->type().attr("__name__"));
  const py::object error = py::module_::import("burr._burr").attr("Error");
  py::raise_from(*failed, error.ptr(),
                 fmt::format("the function for the event \"{}\" raised {}{}{}; it is not called "
                             "again",
                             event, type, why.empty() ? "" : ": ", why)
                     .c_str());
  throw py::error_already_set();
}

void Events::stop(bool tell) {
  if (helper_->thread.joinable() && helper_->thread.get_id() == std::this_thread::get_id() && tell)
    raise("a function for an event cannot close its session");
  if (at_exit_) py::module_::import("atexit").attr("unregister")(std::exchange(at_exit_, {}));
  helper_->stop(tell);
}

int Events::visit(visitproc visitor, void* arg) const {
  for (const py::object& call : helper_->calls)
    if (const int stop = visitor(call.ptr(), arg); stop != 0) return stop;
  return 0;
}

void Events::forget() {
  // what they hold may end other objects of Python, so it goes when nothing is locked
  std::vector<py::object> gone(helper_->calls.size(), py::none());
  std::optional<py::error_already_set> failed;
  const std::lock_guard lock(helper_->mutex);
  helper_->quiet = true;
  gone.swap(helper_->calls);
  failed.swap(helper_->failed);
}

void add_events(py::module_& module) {
  py::class_<Event> event(module, "Event", "What a function of Session.on() is given.");
  event.def_readonly("event", &Event::what);
  event.def_readonly("first_tick", &Event::first_tick);
  event.def_readonly("tick", &Event::tick);
  event.def_readonly("count", &Event::count);
  event.def_property_readonly("p_m", [](const Event& self) { return array_of(self.p); });
  event.def_readonly("voxels", &Event::voxels);
  event.def_readonly("structure", &Event::structure);
  event.def_readonly("distance_m", &Event::distance_m);
  event.def_readonly("step", &Event::step);
  event.def("__repr__", [](const Event& self) {
    return fmt::format("<burr.Event {} tick {} count {}>", self.what, self.tick, self.count);
  });
}

}  // namespace burr::python
