// Undo, redo and reset in the worker that ticks, one after the other: whether there was anything to bring back is seen in the tick that
// takes the command, so the page never says what did not happen. A reset is the undo of all strokes, and one undo takes it back.
const Command = {undo: 5, redo: 6, reset: 7};  // tick/command.h, CommandKind
const kNothing = 1e-6;                         // of bone [mm^3]

export class GoBack {
  constructor(burr, tell) {
    this.burr = burr;
    this.tell = tell;
    this.asked = [];      // that wait
    this.now = null;      // {what, command, left, count}
    this.by_reset = 0;    // strokes that the last reset took back; 0: something was cut since
    this.removed = 0;     // when it had
    this.before = null;   // bone that was gone when the finger came down
    this.spoilt = false;  // a second finger came: what was cut since is taken back when the hand has let go
    this.for_good = false;
  }
  // what: 'undo', 'redo', 'reset'
  ask(what) { this.asked.push(what); }
  press() { this.before = this.burr.core_removed(); }
  take_back() { this.spoilt = this.before !== null; }
  hand_moved() {
    if (!this.spoilt) return;
    this.spoilt = false;
    this.asked.push('take_back');
  }

  // After the ticks of a beat; gives how many ticks it has made itself.
  step() {
    const {burr} = this;
    let ticks = 0;
    while (!burr.core_restoring()) {
      if (!this.now) {
        const what = this.asked.shift();
        if (what === undefined) return ticks;
        this.begin(what);
        if (!this.now) continue;
      }
      const {now} = this;
      if (now.left-- === 0) {
        this.end(now);
        continue;
      }
      burr.core_command(now.command, 0);
      burr.core_step(1);
      ++ticks;
      if (burr.core_restoring()) ++now.count;
      else this.end(now);
    }
    return ticks;
  }

  begin(what) {
    const gone = this.burr.core_removed();
    if (this.by_reset > 0 && Math.abs(gone - this.removed) > kNothing) this.by_reset = 0;
    if (what === 'take_back') {
      if (this.before === null || gone - this.before < kNothing) return;
      this.before = null;
      this.now = {what, command: Command.undo, left: 1, count: 0};
    } else if (what === 'undo' && this.by_reset > 0) {
      this.now = {what, command: Command.redo, left: this.by_reset, count: 0};
      this.by_reset = 0;
    } else if (what === 'reset') {
      this.now = {what, command: this.for_good ? Command.reset : Command.undo, left: this.for_good ? 1 : Infinity, count: 0};
    } else {
      this.now = {what, command: Command[what], left: 1, count: 0};
    }
  }
  // whole: a reset has come to the start.
  end({what, command, count}) {
    this.now = null;
    const did = count > 0;
    const whole = this.burr.core_removed() < kNothing;
    if (what === 'reset') {
      this.by_reset = command === Command.undo ? this.by_reset + count : 0;
      this.removed = this.burr.core_removed();
      this.for_good = !whole;  // the oldest strokes are forgotten: the next reset brings all back, and cannot be undone
    } else if (did) {
      this.by_reset = 0;
      this.for_good = false;
    }
    this.tell({kind: 'went_back', what, did, whole, of_reset: what === 'undo' && command === Command.redo});
  }
}
