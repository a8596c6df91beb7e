// Scenes: a bone, a case, a tool and their settings; sessions: a scene with a hand, stepped.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <mutex>
#include <numbers>
#include <thread>
#include <utility>

#include "burr/device/pushed_hand.h"
#include "burr/device/simulated_hand.h"
#include "burr/edit/bone_memory.h"
#include "burr/record/recorder.h"
#include "burr/scenario/case.h"
#include "burr/scenario/rack.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/flag_words.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/mesh_shape.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/other_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recording.h"
#include "burr/workshop/spared.h"
#include "common.h"
#include "python_events.h"
#include "python_eye.h"
#include "python_law.h"
#include "python_rows.h"
#include "scene_setup.h"

namespace burr::python {
namespace {

using namespace py::literals;

constexpr double kPi = std::numbers::pi;

// ---- hands

struct Hand {
  std::string motion;     // empty: pushed, or a path
  device::HandPath path;  // no points: pushed, or a motion
  double seconds = 10;    // of a motion
  device::ArmSettings arm;
};

device::ArmSettings arm_named(const std::string& grip) {
  device::ArmSettings arm;
  if (grip == "rigid")
    arm.stiffness = INFINITY;
  else if (grip == "light")
    arm = {.mass = 0.06, .damping = 5, .stiffness = 200};
  else if (grip != "firm")
    raise(fmt::format("grip \"{}\" is not known; use firm, light or rigid", grip));
  return arm;
}

math::Quat quat_of(const py::object& given) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array || array.size() != 4) {
    PyErr_Clear();
    raise("a quaternion is four numbers: w, x, y, z");
  }
  const double* v = array.data();
  const math::Quat q(v[0], v[1], v[2], v[3]);
  const double norm = q.norm();
  if (!(std::abs(norm - 1) < 1e-3)) raise("a quaternion must have the length 1: w, x, y, z");
  return math::Quat(q.normalized());
}

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

Hand path_hand(const Doubles& t, const Doubles& points, const py::object& quats,
               const py::object& pedal, const std::string& grip) {
  const auto count = static_cast<std::size_t>(t.size());
  if (count == 0 || points.ndim() != 2 || points.shape(0) != t.size() || points.shape(1) != 3)
    raise("a path needs t (n) [s] and p (n, 3) [m]");
  std::optional<Doubles> q, down;
  if (!quats.is_none()) q = Doubles::ensure(quats);
  if (!pedal.is_none()) down = Doubles::ensure(pedal);
  if ((q && static_cast<std::size_t>(q->size()) != 4 * count) ||
      (down && static_cast<std::size_t>(down->size()) != count))
    raise("a path needs q (n, 4) as w, x, y, z, and pedal (n), or none of them");
  Hand hand;
  hand.arm = arm_named(grip);
  for (std::size_t n = 0; n < count; ++n) {
    device::PathPoint point;
    point.t = t.data()[n];
    if (!(point.t >= (n == 0 ? 0 : hand.path.points.back().t)))
      raise("the times of a path begin at 0 or later and never decrease");
    for (int axis = 0; axis < 3; ++axis)
      point.world_from_tool.p[axis] = points.data()[3 * n + static_cast<std::size_t>(axis)];
    if (q) {
      const double* v = q->data() + 4 * n;
      point.world_from_tool.q = math::Quat(v[0], v[1], v[2], v[3]).normalized();
    }
    if (down) point.pedal = down->data()[n];
    if (!point.world_from_tool.finite() || !std::isfinite(point.pedal))
      raise(fmt::format("point {} of the path has a number that is not finite", n));
    hand.path.points.push_back(point);
  }
  return hand;
}

// ---- scenes

bool names_a_case(const std::string& source) {
  const auto known = scenario::built_in_cases();
  std::error_code nobody_asks;
  return (std::find(known.begin(), known.end(), source) != known.end() &&
          !std::filesystem::exists(source, nobody_asks)) ||
         std::filesystem::path(source).extension() == ".toml";
}

SceneSetup make_scene(const py::object& source, const py::object& name, std::uint32_t number,
                      const py::object& burr_mm, const py::object& rpm, const py::object& tool,
                      const std::string& tools, double voxel_mm, const std::string& materials,
                      const py::object& call) {
  SceneSetup scene;
  scene.tools = tools;
  scenario::BoneRecipe recipe;
  recipe.voxel_mm = voxel_mm;
  recipe.materials = materials;
  if (!name.is_none()) scene.work = take(scenario::read_case(name.cast<std::string>()));
  if (py::isinstance<BoneBox>(source)) {
    if (voxel_mm != 0 || !materials.empty() || number != 0)
      raise("voxel_mm, materials and bone_number are for a bone that is opened here");
    scene.bone = source.cast<BonePtr>();
  } else {
    recipe.source = source.cast<std::string>();
    if (names_a_case(recipe.source)) {
      if (scene.work) raise("give either a case as the source, or a bone and a case");
      scene.work = take(scenario::read_case(recipe.source));
      check(workshop::take_bone(*scene.work, number));
      recipe = workshop::recipe_of(*scene.work, recipe);
    } else if (number != 0) {
      raise("bone_number: only a case has other bones; name a case as the source");
    }
    open_bone(scene, recipe, call);
  }
  take_work(scene, burr_mm.is_none());
  if (!burr_mm.is_none()) scene.settings["burr_mm"] = burr_mm.cast<double>();
  if (!rpm.is_none()) scene.settings["rpm"] = rpm.cast<double>();
  if (!tool.is_none()) scene.tool = tool.cast<std::string>();
  return scene;
}

}  // namespace

void open_bone(SceneSetup& scene, const scenario::BoneRecipe& recipe, const py::object& call) {
  Work work(call);
  auto made = take(work.run([&] { return workshop::open_bone(recipe, work); }));
  scene.bone = box(std::move(made.bone));
  scene.bone->recipe = recipe;
  scene.bone->format = made.summary.format;
  scene.bone->notices = std::move(made.summary.notices);
}

void take_work(SceneSetup& scene, bool own_burr) {
  if (!scene.work) return;
  const scenario::Case& work = *scene.work;
  check(scenario::check_tissues(work, scene.bone->bone->tissues()));
  scene.title = work.title;
  scene.motion = work.motion;
  scene.seconds = work.seconds;
  double burr_mm = scenario::burr_mm(work);
  scene.settings["rpm"] = scenario::rpm(work);
  scene.settings["diamond"] = own_burr && work.burr.kind == tool::BurrKind::diamond;
  if (own_burr) {
    scene.tool = work.tool;
    workshop::fit_burr(burr_mm, scene.bone->bone->grid().voxel, scene.bone->notices);
  }
  scene.settings["burr_mm"] = burr_mm;
  check(workshop::check_session(work));
  if (work.session)
    for (const scenario::CaseSettings::Field& field : work.session->fields)
      scene.put(field.word, field.value);
}

namespace {

sim::SessionSettings settings_of(const SceneSetup& scene) {
  sim::SessionSettings settings;
  settings.threads = std::clamp(scene.threads, 1, 64);
  tick::ServoSettings& servo = settings.servo;
  servo = servo_of(scene);
  if (!scene.tool.empty()) {
    scenario::Rack rack = scene.tools.empty()
                              ? scenario::built_in_rack()
                              : take(scenario::read_rack(scene.tools, workshop::mesh_shape));
    if (scene.work)
      for (const scenario::RackTool& own : scene.work->own_tools) rack.put(own);
    const scenario::RackTool tool = take(rack.get(scene.tool));
    servo.tools = {{tool.name, tool.tool, tool.cutter}};
    servo.tool = 0;
  }
  return settings;
}

surgeon::WorkPlace place_of(const SceneSetup& scene) {
  std::optional<math::Vec3> at, into;
  if (scene.work) {
    // in mm and back, as the command line has it
    if (scene.work->at)
      at = math::Vec3(1e3 * scene.work->at->x(), 1e3 * scene.work->at->y(),
                      1e3 * scene.work->at->z()) *
           1e-3;
    into = scene.work->into;
  }
  return take(surgeon::find_work_place(*scene.bone->bone, 0.5e-3 * scene.burr_mm(), at, into));
}

// ---- sessions

class Session;

struct Snapshot {
  edit::BoneState state;
  std::shared_ptr<const int> of;  // the session's own mark
};

class Session {
 public:
  Session(const SceneSetup& scene, const Hand& hand, const std::string& record, bool embed,
          bool force, bool rows, bool voxels, const py::object& call);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // While it lives, no other thread of Python uses this session.
  class Use {
   public:
    explicit Use(Session& session, bool to_tick = false);
    ~Use() { session_.busy_.store(false); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    sim::Session* operator->() const { return session_.session_.get(); }
    sim::Session& operator*() const { return *session_.session_; }

   private:
    Session& session_;
  };

  std::uint64_t step(std::uint64_t ticks);
  void close();
  [[nodiscard]] bool closed() const { return closed_; }
  void push(const py::object& p, const py::object& q, const py::object& pedal,
            const py::object& buttons, std::uint64_t ticks);
  py::object row();
  py::array rows();
  py::array voxels(bool out);
  BonePtr bone();
  Snapshot snapshot();
  void reset_to(const Snapshot* snapshot);
  py::dict outcome();
  void command(tick::CommandKind kind, double value = 0);
  // Drawn off-screen; python_eye.h.
  py::array picture(const std::string& path, int width, int height);
  py::array patch(const py::object& p, int edge);
  // Tells a function of Python what happens; python_events.h.
  void on(Wanted wanted);
  [[nodiscard]] Events* events() const { return events_.get(); }
  void observe(const py::object& what, double every_ms);
  [[nodiscard]] const py::object& observer() const { return observer_; }
  void forget_observer() { observer_ = py::none(); }
  std::uint64_t ticks();
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] double rate() const { return session_->settings().servo.rate_hz; }
  [[nodiscard]] bool finished() { return Use(*this)->hand().finished(); }

 private:
  void start_recording(const SceneSetup& scene, const Hand& hand, bool embed);
  std::uint64_t make_ticks(std::uint64_t ticks);
  void finish();
  void sort_voxels(sim::Session& session);
  void note();           // after each tick
  void look_at_steps();  // while the session stands
  [[nodiscard]] std::uint64_t step_some(sim::Session& session, std::uint64_t ticks, Work& work);
  [[nodiscard]] std::uint64_t step_observed(sim::Session& session, std::uint64_t ticks, Work& work);
  void show_rows(sim::Session& session);

  BonePtr whole_;  // the bone before the first cut
  std::optional<scenario::Case> work_;
  std::unique_ptr<Events> events_;
  std::unique_ptr<Eye> eye_;
  std::function<surgeon::WorkPlace()> place_;  // for pictures
  rt::Latest<tick::TickRow> watch_;
  std::unique_ptr<sim::Session> session_;
  std::unique_ptr<record::Recorder> recorder_;
  device::PushedHand* pushed_ = nullptr;
  std::string file_;
  std::mutex trouble_mutex_;
  std::string trouble_;  // of the recorder, by its thread
  bool closed_ = false, keeps_voxels_ = false, keeps_rows_ = false, placed_ = false;
  pid_t process_ = getpid();
  std::atomic<bool> busy_ = false;
  std::vector<sim::CrossedVoxel> out_, in_;
  tick::TickRow newest_;
  std::shared_ptr<PythonLaw> law_;  // none: no law, or a compiled one
  py::object observer_ = py::none();
  std::uint64_t observe_every_ = 0, observe_next_ = 0;  // [ticks]
  std::vector<tick::TickRow> seen_;                     // by the observer, not yet taken by rows()
  std::atomic<std::thread::id> observing_;  // the thread on which the observer is called now
  double pedal_ = 0;
  std::uint32_t buttons_ = 0;
  std::uint64_t made_ = 0;  // ticks, at the end of the last step()
  py::dtype row_type_ = row_type();
  std::shared_ptr<const int> mark_ = std::make_shared<const int>(0);
};

Session::Use::Use(Session& session, bool to_tick) : session_(session) {
  if (getpid() != session.process_)
    raise("this session was made before a fork, in another process; make a new one here");
  if (to_tick && session.closed_) raise("this session is closed; make a new one");
  if (session.busy_.exchange(true)) raise("this session is in use by another thread");
}

Session::Session(const SceneSetup& scene, const Hand& hand, const std::string& record, bool embed,
                 bool force, bool rows, bool voxels, const py::object& call)
    : whole_(scene.bone),
      work_(scene.work),
      file_(record),
      keeps_voxels_(voxels),
      keeps_rows_(rows) {
  std::error_code nobody_asks;
  if (!record.empty() && !force && std::filesystem::exists(record, nobody_asks))
    raise(fmt::format("{} exists; give force=True to replace it", record));
  sim::SessionSettings settings = settings_of(scene);
  settings.law = own_law(scene.law, scene.law_settings);
  law_ = std::dynamic_pointer_cast<PythonLaw>(settings.law);
  std::unique_ptr<device::Device> device;
  if (!hand.motion.empty() || !hand.path.points.empty()) {
    device::HandPath path = hand.path;
    if (!hand.motion.empty())
      path = take(
          surgeon::motion(hand.motion, place_of(scene), settings.servo.burr.radius, hand.seconds));
    device = std::make_unique<device::SimulatedHand>(std::move(path), hand.arm);
  } else {
    auto pushed = std::make_unique<device::PushedHand>(hand.arm);
    pushed_ = pushed.get();
    device = std::move(pushed);
  }
  Work work(call);
  session_ = take(work.run([&] {
    return sim::Session::make(volume::copy_of(*scene.bone->bone), std::move(device), settings,
                              work);
  }));
  SceneSetup without_functions = scene;
  without_functions.wanted.clear();
  place_ = [mine = std::move(without_functions)] { return place_of(mine); };
  if (!record.empty()) start_recording(scene, hand, embed);
  if (rows || voxels) session_->keep_in_memory(rows, voxels);
  for (const Wanted& wanted : scene.wanted) on(wanted);
}

void Session::start_recording(const SceneSetup& scene, const Hand& hand, bool embed) {
  workshop::About about;
  about.recipe = scene.bone->recipe;
  about.format = scene.bone->format;
  about.motion = !hand.motion.empty() ? hand.motion : pushed_ ? "python" : "hand path";
  about.embed = embed || scene.bone->recipe.source.empty();  // nobody else has this bone
  about.work_case = scene.work;
  if (scene.work) about.spared = workshop::to_spare(session_->bone().tissues(), scene.work->spare);
  recorder_ = take(workshop::record(*session_, file_, about, [this](const Error& error) {
    const std::lock_guard lock(trouble_mutex_);
    trouble_ = error.text;
  }));
}

Session::~Session() {
  if (getpid() != process_) {  // its threads are in the other process: nobody would end them
    static_cast<void>(session_.release());
    static_cast<void>(recorder_.release());
    static_cast<void>(events_.release());
    static_cast<void>(eye_.release());
    return;
  }
  events_.reset();
  const py::gil_scoped_release others_may;
  if (recorder_) {
    session_->settle();
    session_->set_recorder(nullptr);
    recorder_.reset();
  }
  session_.reset();
}

void Session::close() {
  if (closed_) return;
  if (events_) {
    look_at_steps();
    events_->stop(true);  // no lock is held: the functions called now may use the session
  }
  finish();
  if (events_) events_->raise_what_failed();
}

void Session::finish() {
  Use use(*this);
  closed_ = true;
  if (!recorder_) return;
  const auto written = [&] {
    const py::gil_scoped_release others_may;
    use->settle();
    use->set_recorder(nullptr);
    return recorder_->finish();
  }();
  recorder_.reset();
  if (!written) throw Raised(written.error());
}

py::array Session::picture(const std::string& path, int width, int height) {
  only_main_thread();
  Use use(*this);
  if (!eye_) {
    const surgeon::WorkPlace place = place_();
    eye_ = std::make_unique<Eye>(*use, place.at, -place.into);
  }
  tick::TickRow now;
  if (use->view(now)) newest_ = now;
  Work work;
  const auto row = use->ticks() > 0 ? std::optional(newest_) : std::nullopt;
  return array_of(eye_->look(row, width, height, work), path);
}

py::array Session::patch(const py::object& p, int edge) {
  Use use(*this);
  tick::TickRow now;
  if (use->view(now)) newest_ = now;
  if (p.is_none() && use->ticks() == 0) raise("the burr is nowhere yet; give p, or step() first");
  return patch_of(use->bone(), p.is_none() ? newest_.contact.proxy : vec3_of(p, "p"), edge);
}

void Session::on(Wanted wanted) {
  Use use(*this, true);
  if (!events_) {
    events_ = std::make_unique<Events>(whole_, work_);
    use->set_watch(&watch_);
    use->set_between_ticks([this] { note(); }, 1);
  }
  events_->add(std::move(wanted), keeps_voxels_);
}

void Session::note() {
  tick::TickRow row;
  if (watch_.take(row)) events_->note(row);
  if (!keeps_voxels_) return;
  const std::size_t out = out_.size();
  sort_voxels(*session_);
  for (std::size_t n = out; n < out_.size(); ++n) events_->note(out_[n]);
}

void Session::look_at_steps() {
  if (!events_->watches_steps()) return;
  Use use(*this);
  std::unique_ptr<volume::Bone> now;
  {
    const py::gil_scoped_release others_may;
    now = volume::copy_of(use->bone());
  }
  events_->look(std::move(now), use->ticks());
}

std::uint64_t Session::step(std::uint64_t ticks) {
  if (events_) events_->raise_what_failed();
  const std::uint64_t made = make_ticks(ticks);
  if (events_ && events_->wants_bone(made_)) look_at_steps();
  return made;
}

std::uint64_t Session::make_ticks(std::uint64_t ticks) {
  Use use(*this, true);
  if (pushed_ != nullptr && !placed_)
    raise("nobody said where the hand is; call hand() before the first step()");
  Work work;
  if (law_) law_->set_work(&work);
  const std::uint64_t made =
      observer_.is_none() ? step_some(*use, ticks, work) : step_observed(*use, ticks, work);
  made_ = use->ticks();
  if (law_) {
    law_->set_work(nullptr);
    law_->raise_again();
  }
  {
    const std::lock_guard lock(trouble_mutex_);
    if (!trouble_.empty()) raise(std::exchange(trouble_, {}));
  }
  return made;
}

std::uint64_t Session::step_some(sim::Session& session, std::uint64_t ticks, Work& work) {
  return work.run([&] {
    const std::uint64_t made = session.step(ticks, work);
    if (events_) note();
    return made;
  });
}

std::uint64_t Session::step_observed(sim::Session& session, std::uint64_t ticks, Work& work) {
  std::uint64_t made = 0;
  while (made < ticks) {
    const std::uint64_t some = std::min(ticks - made, observe_next_ - session.ticks());
    const std::uint64_t now = step_some(session, some, work);
    made += now;
    if (session.ticks() >= observe_next_) {
      observe_next_ = session.ticks() + observe_every_;
      show_rows(session);
    }
    if (now < some) break;
  }
  return made;
}

// Between two ticks. Wishes of the observer are taken by the next one.
void Session::show_rows(sim::Session& session) {
  std::vector<tick::TickRow> rows = session.log()->take_rows();
  const py::array shown = rows_array(rows_of(rows), row_type_);
  if (keeps_rows_)
    seen_.insert(seen_.end(), std::make_move_iterator(rows.begin()),
                 std::make_move_iterator(rows.end()));
  struct Calls {
    std::atomic<std::thread::id>& who;
    ~Calls() { who = std::thread::id(); }
  } calls{observing_};
  observing_ = std::this_thread::get_id();
  const py::object observer = observer_;  // it may stop observing
  observer(shown);
}

void Session::observe(const py::object& what, double every_ms) {
  Use use(*this, true);
  if (!what.is_none() && PyCallable_Check(what.ptr()) == 0)
    raise("observe() wants a function of the rows, or None");
  const double ticks = std::round(1e-3 * every_ms * use->settings().servo.rate_hz);
  if (!(ticks >= 1 && ticks < 1e9))
    raise(fmt::format("every_ms {} is not possible; use a tick or more, for example 20", every_ms));
  const auto keep = [&](std::vector<tick::TickRow>& into) {
    if (use->log() == nullptr || !use->log()->keeps_rows()) return;
    for (const tick::TickRow& row : use->log()->take_rows()) into.push_back(row);
  };
  if (keeps_rows_) {
    keep(seen_);  // they are not news for the observer
  } else {
    if (keeps_voxels_) sort_voxels(*use);
    use->keep_in_memory(!what.is_none(), keeps_voxels_);
  }
  observer_ = what;
  observe_every_ = static_cast<std::uint64_t>(ticks);
  observe_next_ = use->ticks() + observe_every_;
}

void Session::push(const py::object& p, const py::object& q, const py::object& pedal,
                   const py::object& buttons, std::uint64_t ticks) {
  Use use(*this, true);
  if (pushed_ == nullptr)
    raise("this hand follows its motion or path; only a pushed hand can be told");
  math::Pose there = pushed_->goal();
  if (!p.is_none())
    there.p = vec3_of(p, "p");
  else if (!placed_)
    raise("say where the hand is: p");
  if (!q.is_none()) there.q = quat_of(q);
  if (!pedal.is_none()) pedal_ = pedal.cast<double>();
  if (!(pedal_ >= 0 && pedal_ <= 1))
    raise(fmt::format("a pedal of {} is not possible; use 0 to 1", pedal_));
  if (!buttons.is_none()) buttons_ = buttons.cast<std::uint32_t>();
  if (ticks == 0)
    pushed_->place(there, pedal_, buttons_);
  else
    pushed_->move(there, pedal_, buttons_, ticks);
  placed_ = true;
}

py::object Session::row() {
  Use use(*this);
  tick::TickRow now;
  if (use->view(now)) newest_ = now;
  if (use->ticks() == 0) return py::none();
  return rows_array(rows_of({newest_}), row_type_)[py::int_(0)];
}

py::array Session::rows() {
  Use use(*this);
  if (!keeps_rows_) raise("this session keeps no rows; make it with rows=True");
  std::vector<Row> out;
  {
    const py::gil_scoped_release others_may;
    std::vector<tick::TickRow> all = std::exchange(seen_, {});
    for (const tick::TickRow& row : use->log()->take_rows()) all.push_back(row);
    out = rows_of(all);
  }
  return rows_array(std::move(out), row_type_);
}

void Session::sort_voxels(sim::Session& session) {
  for (const sim::CrossedVoxel& voxel : session.log()->take_voxels())
    (voxel.out ? out_ : in_).push_back(voxel);
}

py::array Session::voxels(bool out) {
  Use use(*this);
  if (!keeps_voxels_) raise("this session keeps no voxels; make it with voxels=True");
  sort_voxels(*use);
  std::vector<std::int32_t> flat;
  const std::vector<sim::CrossedVoxel> taken = std::exchange(out ? out_ : in_, {});
  flat.reserve(4 * taken.size());
  for (const sim::CrossedVoxel& voxel : taken)
    flat.insert(flat.end(), {static_cast<std::int32_t>(voxel.tick), voxel.i, voxel.j, voxel.k});
  return as_array(std::move(flat), {static_cast<py::ssize_t>(taken.size()), 4});
}

BonePtr Session::bone() {
  Use use(*this);
  std::unique_ptr<volume::Bone> copy;
  {
    const py::gil_scoped_release others_may;
    copy = volume::copy_of(use->bone());
  }
  return box(std::move(copy));
}

Snapshot Session::snapshot() {
  Use use(*this);
  return {use->bone_state(), mark_};
}

void Session::reset_to(const Snapshot* snapshot) {
  Use use(*this, true);
  if (snapshot != nullptr && snapshot->of != mark_) raise("this snapshot is of another session");
  Status done = fine();
  {
    const py::gil_scoped_release others_may;
    done = use->reset_to(snapshot != nullptr ? snapshot->state : edit::BoneState());
  }
  check(done);
  if (events_) events_->start_over();
  out_.clear();
  in_.clear();
  seen_.clear();
  observe_next_ = observe_every_;
  newest_ = {};
  made_ = 0;
  placed_ = false;
  pedal_ = 0;
  buttons_ = 0;
}

std::uint64_t Session::ticks() { return Use(*this)->ticks(); }

py::dict Session::outcome() {
  Use use(*this);
  const sim::Outcome outcome = use->outcome();
  const edit::Ledger& ledger = outcome.ledger;
  return py::dict("ticks"_a = outcome.ticks, "seconds"_a = outcome.seconds,
                  "removed_mm3"_a = 1e9 * ledger.removed, "asked_mm3"_a = 1e9 * ledger.asked,
                  "not_cut_mm3"_a = 1e9 * ledger.not_cut, "owed_mm3"_a = 1e9 * ledger.debt,
                  "added_mm3"_a = 1e9 * ledger.added, "undone_mm3"_a = 1e9 * ledger.undone,
                  "cutting_energy_j"_a = ledger.energy, "peak_force_n"_a = outcome.peak_force,
                  "mean_force_n"_a = outcome.mean_force,
                  "noted"_a = tick::words(tick::worth_telling(outcome.flags)));
}

void Session::command(tick::CommandKind kind, double value) {
  if (!std::isfinite(value)) raise("a setting must be a finite number");
  if (observing_.load() == std::this_thread::get_id())
    session_->command({kind, value});  // from the observer, while step() waits for it
  else
    Use(*this, true)->command({kind, value});
}

double mode_named(const std::string& name) {
  constexpr const char* kNames[] = {"cut", "add", "touch", "restore", "smooth"};
  for (int n = 0; n < 5; ++n)
    if (name == kNames[n]) return n;
  raise(fmt::format("mode \"{}\" is not known; use cut, add, touch, restore or smooth", name));
}

// Python's collector finds functions that hold the object which holds them.
int visit_all(const Session& session, visitproc visit, void* arg) {
  if (const int stop = visit(session.observer().ptr(), arg); stop != 0) return stop;
  return session.events() != nullptr ? session.events()->visit(visit, arg) : 0;
}
int visit_all(const SceneSetup& scene, visitproc visit, void* arg) {
  if (const int stop = visit(scene.law.ptr(), arg); stop != 0) return stop;
  for (const Wanted& wanted : scene.wanted)
    if (const int stop = visit(wanted.call.ptr(), arg); stop != 0) return stop;
  return 0;
}
void forget(Session& session) {
  session.forget_observer();
  if (session.events() != nullptr) session.events()->forget();
}
void forget(SceneSetup& scene) {
  scene.law = py::none();
  scene.wanted.clear();
}

template <class Type>
Type* held_by(PyObject* self) {
  auto* instance = reinterpret_cast<py::detail::instance*>(self);
  return static_cast<Type*>(instance->get_value_and_holder().value_ptr());
}

template <class Type>
py::custom_type_setup seen_by_collector() {
  return py::custom_type_setup([](PyHeapTypeObject* made) {
    PyTypeObject& type = made->ht_type;
    type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) -> int {
      if (const int stop = visit(reinterpret_cast<PyObject*>(Py_TYPE(self)), arg); stop != 0)
        return stop;
      const Type* held = held_by<Type>(self);
      if (held == nullptr) return 0;
      return visit_all(*held, visit, arg);
    };
    type.tp_clear = [](PyObject* self) -> int {
      if (Type* held = held_by<Type>(self)) forget(*held);
      return 0;
    };
  });
}

void want(Session& session, Wanted wanted) { session.on(std::move(wanted)); }
void want(SceneSetup& scene, Wanted wanted) { scene.wanted.push_back(std::move(wanted)); }

template <class Type>
void add_on(py::class_<Type>& type) {
  type.def(
      "on",
      [](Type& self, const std::string& event, const py::object& call, const py::object& label,
         const py::object& structure, const py::object& mm, const py::object& step) {
        want(self, wanted_of(event, call, label, structure, mm, step));
      },
      "event"_a, "call"_a, py::kw_only(), "label"_a = py::none(), "structure"_a = py::none(),
      "mm"_a = py::none(), "step"_a = py::none(),
      "Calls a function with an Event, on a helper thread: touch, leave, removed, near, "
      "step_reached.");
}

void add_hand(py::module_& module) {
  py::class_<Hand>(module, "Hand", "Who holds the tool.")
      .def_static(
          "pushed",
          [](double mass_kg, double damping_n_s_per_m, double stiffness_n_per_m) {
            return Hand{{}, {}, 0, {mass_kg, damping_n_s_per_m, stiffness_n_per_m}};
          },
          py::kw_only(), "mass_kg"_a = 0.1, "damping_n_s_per_m"_a = 10.0,
          "stiffness_n_per_m"_a = INFINITY,
          "Told by Session.hand(). Stiffness inf: it is where it is told to be; else the bone "
          "pushes it away.")
      .def_static(
          "motion",
          [](const std::string& name, double seconds, const std::string& grip) {
            const auto known = surgeon::motion_names();
            if (std::find(known.begin(), known.end(), name) == known.end())
              raise(fmt::format("motion \"{}\" is not known; burr.motions() lists them", name));
            return Hand{name, {}, seconds, arm_named(grip)};
          },
          "name"_a, py::kw_only(), "seconds"_a = 10.0, "grip"_a = "firm",
          "Makes a motion at the place where the work of the scene begins.")
      .def_static("path", &path_hand, "t"_a, "p"_a, "q"_a = py::none(), "pedal"_a = py::none(),
                  py::kw_only(), "grip"_a = "firm", "t (n) [s], p (n, 3) [m], q (n, 4) w x y z.");
}

void add_session(py::module_& module) {
  py::class_<Snapshot>(module, "Snapshot", "A bone as it was in a session, for reset_to().");
  py::class_<Session> session(module, "Session", "A scene with a hand, moved by step().",
                              seen_by_collector<Session>());
  add_on(session);
  session.def(
      "step", &Session::step, "ticks"_a = 1,
      "Makes so many ticks without the GIL; returns how many: fewer when the hand has finished.");
  session.def("hand", &Session::push, "p"_a = py::none(), "q"_a = py::none(),
              "pedal"_a = py::none(), "buttons"_a = py::none(), py::kw_only(), "ticks"_a = 1,
              "Where the hand is after so many ticks (0: at once, at rest). p [m], q w x y z.");
  session.def_property_readonly("row", &Session::row);
  session.def("rows", &Session::rows, "The rows of all ticks since the last call.");
  session.def(
      "removed", [](Session& self) { return self.voxels(true); },
      "int32 (n, 4): tick, i, j, k of the voxels that left the bone since the last call.");
  session.def(
      "added", [](Session& self) { return self.voxels(false); },
      "The same of voxels that became bone.");
  session.def("bone", &Session::bone, "A copy of the bone as it is now.");
  session.def("snapshot", &Session::snapshot);
  session.def("reset_to", &Session::reset_to, "snapshot"_a = py::none(),
              "Puts the bone back (None: to the beginning) and starts over at tick 0.");
  session.def("outcome", &Session::outcome);
  session.def("picture", &Session::picture, "path"_a = "", py::kw_only(), "width"_a = 640,
              "height"_a = 480, "(height, width, 3) uint8, drawn off-screen; path: a .png too.");
  session.def("patch", &Session::patch, "p"_a = py::none(), py::kw_only(), "edge"_a = 16,
              "The field round the burr: (edge, edge, edge) uint8, 128 is the surface.");
  session.def_property_readonly("ticks", &Session::ticks);
  session.def_property_readonly(
      "seconds", [](Session& self) { return static_cast<double>(self.ticks()) / self.rate(); });
  session.def_property_readonly("rate_hz", &Session::rate);
  session.def_property_readonly("finished", &Session::finished);
  session.def_property_readonly("closed", &Session::closed);
  session.def_property_readonly("recording", [](const Session& self) -> py::object {
    return self.file().empty() ? py::object(py::none()) : py::object(py::str(self.file()));
  });
  session.def("undo", [](Session& self) { self.command(tick::CommandKind::undo); });
  session.def("redo", [](Session& self) { self.command(tick::CommandKind::redo); });
  session.def("reset", [](Session& self) { self.command(tick::CommandKind::reset); });
  session.def(
      "set_burr_mm",
      [](Session& self, double mm) { self.command(tick::CommandKind::burr_radius, 0.5e-3 * mm); },
      "diameter"_a);
  session.def(
      "set_rpm",
      [](Session& self, double rpm) {
        self.command(tick::CommandKind::spindle_speed, rpm * 2 * kPi / 60);
      },
      "rpm"_a);
  session.def(
      "set_stiffness_n_per_m",
      [](Session& self, double stiffness) {
        self.command(tick::CommandKind::stiffness, stiffness);
      },
      "stiffness"_a);
  session.def(
      "set_mode",
      [](Session& self, const std::string& mode) {
        self.command(tick::CommandKind::tool_mode, mode_named(mode));
      },
      "mode"_a);
  session.def(
      "set_diamond",
      [](Session& self, bool diamond) {
        self.command(tick::CommandKind::burr_kind, diamond ? 1 : 0);
      },
      "diamond"_a);
  session.def("observe", &Session::observe, "f"_a, py::kw_only(), "every_ms"_a = 20.0,
              "Calls f(rows) between ticks, with the rows since the last call. f may use the "
              "commands, undo() and "
              "set_...(), and nothing else of the session. None: no longer.");
  session.def("close", &Session::close, "Finishes the recording; nothing can be stepped after it.");
  session.def("__enter__", [](const py::object& self) { return self; });
  session.def("__exit__", [](Session& self, const py::args&) { self.close(); });
}

}  // namespace

void add_scene(py::module_& module) {
  add_hand(module);
  add_session(module);
  add_events(module);
  py::class_<SceneSetup> scene(module, "Scene", "A bone, a case, a tool and their settings.",
                               seen_by_collector<SceneSetup>());
  add_on(scene);
  add_scene_file(scene);
  add_guidance(scene);
  scene.def(py::init(&make_scene), "source"_a, py::kw_only(), "case"_a = py::none(),
            "bone_number"_a = 0, "burr_mm"_a = py::none(), "rpm"_a = py::none(),
            "tool"_a = py::none(), "tools"_a = "", "voxel_mm"_a = 0.0, "materials"_a = "",
            "progress"_a = py::none());
  scene.def_readonly("bone", &SceneSetup::bone);
  scene.def_property_readonly("case", [](const SceneSetup& self) -> py::object {
    return self.work ? py::object(py::str(self.work->name)) : py::object(py::none());
  });
  scene.def_readwrite("title", &SceneSetup::title);
  scene.def_readwrite("motion", &SceneSetup::motion);
  scene.def_readwrite("seconds", &SceneSetup::seconds);
  scene.def_property_readonly("spare", [](const SceneSetup& self) {
    std::vector<std::string> names;
    for (const volume::TissueId id : workshop::to_spare(
             self.bone->bone->tissues(), self.work ? self.work->spare : std::vector<std::string>()))
      names.push_back(self.bone->bone->tissues()[id].name);
    return names;
  });
  scene.def_property_readonly("targets", [](const SceneSetup& self) {
    py::list out;
    if (!self.work) return out;
    for (const scenario::Target& target : self.work->targets)
      out.append(py::dict("tissue"_a = target.tissue, "goal"_a = scenario::word_of(target.goal),
                          "share"_a = target.share));
    return out;
  });
  scene.def_property_readonly("at_m",
                              [](const SceneSetup& self) { return array_of(place_of(self).at); });
  scene.def_property_readonly("into",
                              [](const SceneSetup& self) { return array_of(place_of(self).into); });
  add_settings(scene);
  scene.def_readwrite("tool", &SceneSetup::tool);
  scene.def_readwrite("tools", &SceneSetup::tools);
  scene.def_readwrite("threads", &SceneSetup::threads);
  scene.def_readwrite("law", &SceneSetup::law);
  scene.def_readwrite("law_settings", &SceneSetup::law_settings);
  scene.def(
      "session",
      [](const SceneSetup& self, const Hand* hand, const std::string& record, bool embed,
         bool force, bool rows, bool voxels, const py::object& call) {
        Hand pushed;
        pushed.arm.stiffness = INFINITY;
        return std::make_unique<Session>(self, hand != nullptr ? *hand : pushed, record, embed,
                                         force, rows, voxels, call);
      },
      "hand"_a = py::none(), py::kw_only(), "record"_a = "", "embed"_a = false, "force"_a = false,
      "rows"_a = true, "voxels"_a = true, "progress"_a = py::none(),
      "A session on a copy of the bone. record: F.mcap; embed: the bone goes into it.");
}

}  // namespace burr::python
