// tests/rt/explore.h - a small model checker for the doors of rt: tries every order in which a few
// threads can take their steps, and every value that an atomic load may then see.
//
//     const Explored all = explore([](Threads& threads) {
//       auto door = std::make_shared<Latest<Cell, ModelAtoms>>();
//       threads.add([door] { door->publish(...); });
//       threads.add([door] { Cell seen; if (door->take(seen)) expect(seen.whole(), "torn"); });
//       threads.at_end([door] { ... });             // sees everything, as after join()
//     });
//     EXPECT_EQ(all.trouble, "");
//
// Each execution starts from the beginning and makes the next untried choices: which thread takes
// the next atomic step, and which of the permitted stores a load sees.
//
// The memory model is C++20 in the form of "views" (Kang et al., "A promising semantics for
// relaxed-memory concurrency", POPL 2017, without promises): relaxed, acquire, release, acq_rel and
// fences. A load may see any store that is not older than what its thread knows of; release passes
// this knowledge on, acquire takes it over. The same knowledge is used to check plain data for
// races: a reader must know of the last write, a writer of all earlier reads and writes.
//
// Not covered: seq_cst (treated as acq_rel; the doors do not use it); stores to one place by
// several threads that take effect in another order than they were made (each place without
// read-modify-write has one writer); loads that see stores that depend on the load (no compiler
// does that); more threads and steps than the test has.
#pragma once

#include <ucontext.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace burr::rt::test {

struct Explored {
  std::uint64_t executions = 0;
  std::string trouble;    // the first failure, and the choices that led to it
  bool complete = false;  // every order was tried
};

class Model {
 public:
  static constexpr int kThreads = 5;  // thread 0 does setup and the final check
  static constexpr std::size_t kPlaces = 64;
  using View = std::array<std::uint16_t, kPlaces + kThreads>;  // stores known, steps known

  static Model*& now() {
    static Model* model = nullptr;
    return model;
  }

  // ---- operations of the model's atomics

  std::size_t place(std::uint64_t value) {
    if (places_.size() == kPlaces) std::abort();  // raise kPlaces
    places_.emplace_back().stores.push_back({value, {}});
    self().known[places_.size() - 1] = 0;
    return places_.size() - 1;
  }
  std::size_t place_of(const void* word, std::uint64_t value) {
    const auto found = words_.find(word);
    return found != words_.end() ? found->second : words_[word] = place(value);
  }

  std::uint64_t load(std::size_t at, std::memory_order order) {
    // other threads cannot change what only this thread writes: no need to let them run first
    Place& place = places_[at];
    if (place.writer == running_ && running_ != 0) {
      place.skipped = true;
    } else {
      step();
    }
    Thread& me = self();
    const auto& stores = places_[at].stores;
    const std::size_t first = me.known[at];
    // the newest first: the usual order on a real machine
    const std::size_t seen = stores.size() - 1 - choose(stores.size() - first);
    me.known[at] = static_cast<std::uint16_t>(seen);
    join(me.seen, stores[seen].view);
    if (acquires(order)) join(me.known, stores[seen].view);
    return stores[seen].value;
  }

  void store(std::size_t at, std::uint64_t value, std::memory_order order) {
    step();
    append(at, value, order, {});
  }

  template <class Change>
  std::uint64_t change(std::size_t at, Change&& changed, std::memory_order order) {
    step();
    Thread& me = self();
    const Store before = places_[at].stores.back();  // follows the last store, whether known or not
    join(me.seen, before.view);
    if (acquires(order)) join(me.known, before.view);
    append(at, changed(before.value), order, before.view);
    return before.value;
  }

  void fence(std::memory_order order) {
    Thread& me = self();
    if (acquires(order)) join(me.known, me.seen);
    if (releases(order)) me.fenced = me.known;
  }

  // ---- plain data

  std::uint64_t plain_load(std::size_t at) {
    Place& place = places_[at];
    if (self().known[at] + std::size_t{1} != place.stores.size())
      fail("a race: plain data is read while its last write is not known");
    place.read_at[static_cast<std::size_t>(running_)] = ++self().known[clock(running_)];
    return place.stores.back().value;
  }
  void plain_store(std::size_t at, std::uint64_t value) {
    Place& place = places_[at];
    Thread& me = self();
    if (me.known[at] + std::size_t{1} != place.stores.size())
      fail("a race: plain data is written while its last write is not known");
    for (int t = 0; t < kThreads; ++t)
      if (t != running_ && me.known[clock(t)] < place.read_at[static_cast<std::size_t>(t)])
        fail("a race: plain data is written while somebody may still read it");
    place.stores.push_back({value, {}});
    me.known[at] = static_cast<std::uint16_t>(place.stores.size() - 1);
  }

  void fail(const std::string& what) {
    if (!trouble_.empty()) return;
    trouble_ = what + "; choices:";
    for (const Choice& choice : choices_) trouble_ += " " + std::to_string(choice.taken);
  }

 private:
  friend class Threads;
  template <class Setup>
  friend Explored explore(Setup&& setup);

  struct Store {
    std::uint64_t value;
    View view;  // what an acquire load learns
  };
  struct Place {
    std::vector<Store> stores;  // in the order in which they take effect
    std::array<std::uint16_t, kThreads> read_at{};
    int writer = 0;  // the only thread that has written; 0: none yet
    bool skipped = false;
  };
  struct Thread {
    View known{};   // older stores may no longer be seen
    View seen{};    // what an acquire fence would add
    View fenced{};  // what a relaxed store passes on, from the last release fence
    std::function<void()> work;
    bool done = true, fresh = true;
    ucontext_t context{};
  };
  struct Choice {
    std::size_t taken, of;
  };

  static bool acquires(std::memory_order order) {
    return order != std::memory_order_relaxed && order != std::memory_order_release;
  }
  static bool releases(std::memory_order order) {
    return order != std::memory_order_relaxed && order != std::memory_order_acquire;
  }
  static void join(View& to, const View& from) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = std::max(to[i], from[i]);
  }
  static std::size_t clock(int thread) { return kPlaces + static_cast<std::size_t>(thread); }
  Thread& self() { return threads_[static_cast<std::size_t>(running_)]; }

  void append(std::size_t at, std::uint64_t value, std::memory_order order, const View& inherited) {
    Thread& me = self();
    Place& place = places_[at];
    if (place.writer == 0) place.writer = running_;
    if (place.writer != running_ && running_ != 0) {
      if (place.skipped) std::abort();  // it has a second writer: load() must not skip
      place.writer = kThreads;          // no single writer
    }
    auto& stores = place.stores;
    me.known[at] = static_cast<std::uint16_t>(stores.size());
    View view = releases(order) ? me.known : me.fenced;
    view[at] = me.known[at];
    join(view, inherited);  // a read-modify-write continues what was released before it
    stores.push_back({value, view});
  }

  // Chooses one of `of` continuations: as planned so far, then the first.
  std::size_t choose(std::size_t of) {
    if (of < 2) return 0;
    if (at_choice_ == choices_.size()) choices_.push_back({0, of});
    if (choices_[at_choice_].of != of) std::abort();  // the test depends on more than its choices
    return choices_[at_choice_++].taken;
  }

  // Before every atomic step: another thread may run first.
  void step() {
    if (running_ == 0) return;
    if (self().fresh) {  // it was just chosen to start
      self().fresh = false;
      return;
    }
    std::array<int, kThreads> ready{};
    std::size_t n = 0;
    ready[n++] = running_;
    for (int t = 1; t < kThreads; ++t)
      if (t != running_ && !threads_[static_cast<std::size_t>(t)].done) ready[n++] = t;
    go_on_with(ready[choose(n)]);
  }
  void go_on_with(int thread) {
    if (thread == running_) return;
    const int before = running_;
    running_ = thread;
    ::swapcontext(&threads_[static_cast<std::size_t>(before)].context,
                  &threads_[static_cast<std::size_t>(thread)].context);
  }

  static void enter() {
    Model& model = *now();
    model.self().work();
    model.self().done = true;
    // the remaining threads; at the very end the one that did the setup
    std::array<int, kThreads> ready{};
    std::size_t n = 0;
    for (int t = 1; t < kThreads; ++t)
      if (!model.threads_[static_cast<std::size_t>(t)].done) ready[n++] = t;
    model.go_on_with(n == 0 ? 0 : ready[model.choose(n)]);
  }

  // a separate function, because getcontext() returns twice
  static void prepare(Thread& thread, std::vector<char>& stack) {
    stack.resize(64 * 1024);
    ::getcontext(&thread.context);
    thread.context.uc_stack.ss_sp = stack.data();
    thread.context.uc_stack.ss_size = stack.size();
    thread.context.uc_link = nullptr;
    ::makecontext(&thread.context, &Model::enter, 0);
  }

  void run_threads() {
    std::array<int, kThreads> ready{};
    std::size_t n = 0;
    for (int t = 1; t < kThreads; ++t) {
      Thread& thread = threads_[static_cast<std::size_t>(t)];
      if (!thread.work) continue;
      thread.known = threads_[0].known;  // as std::thread's constructor does
      thread.done = false;
      thread.fresh = true;
      prepare(thread, stacks_[static_cast<std::size_t>(t)]);
      ready[n++] = t;
    }
    if (n == 0) return;
    go_on_with(ready[choose(n)]);
    for (const Thread& thread : threads_) join(threads_[0].known, thread.known);  // as join() does
  }

  void begin() {
    places_.clear();
    words_.clear();
    for (Thread& thread : threads_) {
      thread.known = thread.seen = thread.fenced = {};
      thread.work = nullptr;
      thread.done = true;
    }
    at_end_ = nullptr;
    running_ = 0;
    at_choice_ = 0;
  }

  // False: no other choice is left.
  bool next_plan() {
    while (!choices_.empty() && choices_.back().taken + 1 == choices_.back().of)
      choices_.pop_back();
    if (choices_.empty()) return false;
    ++choices_.back().taken;
    return true;
  }

  std::vector<Place> places_;
  std::map<const void*, std::size_t> words_;
  std::array<Thread, kThreads> threads_;
  std::array<std::vector<char>, kThreads> stacks_;
  std::function<void()> at_end_;
  int running_ = 0;
  std::vector<Choice> choices_;
  std::size_t at_choice_ = 0;
  std::string trouble_;
};

// The atomics of the doors under the model.
struct ModelAtoms {
  template <class Value>
  class Atomic {
   public:
    Atomic(Value value = {})  // NOLINT(google-explicit-constructor): as std::atomic
        : at_(Model::now()->place(static_cast<std::uint64_t>(value))) {}
    Atomic(const Atomic&) = delete;
    Atomic& operator=(const Atomic&) = delete;
    [[nodiscard]] Value load(std::memory_order order) const {
      return static_cast<Value>(Model::now()->load(at_, order));
    }
    void store(Value value, std::memory_order order) {
      Model::now()->store(at_, static_cast<std::uint64_t>(value), order);
    }
    Value exchange(Value value, std::memory_order order) {
      return static_cast<Value>(Model::now()->change(
          at_, [&](std::uint64_t) { return std::uint64_t{value}; }, order));
    }
    Value fetch_add(Value value, std::memory_order order) {
      return static_cast<Value>(Model::now()->change(
          at_, [&](std::uint64_t was) { return was + value; }, order));
    }
    Value fetch_or(Value value, std::memory_order order) {
      return static_cast<Value>(Model::now()->change(
          at_, [&](std::uint64_t was) { return was | value; }, order));
    }

   private:
    std::size_t at_;
  };

  static void fence(std::memory_order order) { Model::now()->fence(order); }
  static void store(std::uint64_t& word, std::uint64_t value) {
    Model::now()->store(Model::now()->place_of(&word, word), value, std::memory_order_relaxed);
  }
  static std::uint64_t load(const std::uint64_t& word) {
    return Model::now()->load(Model::now()->place_of(&word, word), std::memory_order_relaxed);
  }
};

// Plain data of two words, so that it can be torn.
class Cell {
 public:
  Cell() : first_(Model::now()->place(0)), second_(Model::now()->place(0)) {}
  explicit Cell(std::uint64_t value) : Cell() { put(value, value); }
  Cell(const Cell& other) : Cell() { *this = other; }
  Cell& operator=(const Cell& other) {
    const std::uint64_t a = Model::now()->plain_load(other.first_);
    const std::uint64_t b = Model::now()->plain_load(other.second_);
    put(a, b);
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const {
    const std::uint64_t a = Model::now()->plain_load(first_);
    if (a != Model::now()->plain_load(second_)) Model::now()->fail("torn");
    return a;
  }

 private:
  void put(std::uint64_t a, std::uint64_t b) const {
    Model::now()->plain_store(first_, a);
    Model::now()->plain_store(second_, b);
  }
  std::size_t first_, second_;
};

// The threads of one execution.
class Threads {
 public:
  explicit Threads(Model& model) : model_(model) {}
  void add(std::function<void()> work) {
    if (++count_ == Model::kThreads) std::abort();  // raise kThreads
    model_.threads_[static_cast<std::size_t>(count_)].work = std::move(work);
  }
  void at_end(std::function<void()> look) { model_.at_end_ = std::move(look); }

 private:
  Model& model_;
  int count_ = 0;
};

inline void expect(bool good, const std::string& otherwise) {
  if (!good) Model::now()->fail(otherwise);
}

// Runs `setup` and its threads once for every possible order.
template <class Setup>
Explored explore(Setup&& setup) {
  constexpr std::uint64_t kMost = 20'000'000;  // stops tests that are too large
  auto model = std::make_unique<Model>();
  Model::now() = model.get();
  Explored all;
  do {
    model->begin();
    Threads threads(*model);
    setup(threads);
    model->run_threads();
    if (model->at_end_) model->at_end_();
    ++all.executions;
    if (!model->trouble_.empty()) break;
    all.complete = !model->next_plan();
  } while (!all.complete && all.executions < kMost);
  all.trouble = model->trouble_;
  for (auto& thread : model->threads_) thread.work = nullptr;
  model->at_end_ = nullptr;
  Model::now() = nullptr;
  return all;
}

}  // namespace burr::rt::test
