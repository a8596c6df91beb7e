// The burr in the hand: its size, its speed, how deep a press goes; coolant and suction beside it.
import * as words from '../common/words.js';

const Command = {spindle_speed: 0, burr_radius: 1, irrigation: 12};  // tick/command.h, CommandKind
// as the window offers them (apps/burr/window/mill/drill.cpp)
const kSizes = [0.6, 0.8, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 6.5, 7];  // [mm]
const kRpmStep = 5000, kRpmMost = 80000;
const kDepthStep = 1.25, kLeastDepth = 0.5, kMostDepth = 6;  // of a press  [mm]

export class Tools {
  // host: command(what, value), voxel() [mm], fastest(): the case's speed [rpm], suck(on), say(key)
  constructor(host) {
    this.host = host;
    this.depth = 4;
    this.speed = 80000;  // as they were asked for
    this.size = 5;
    this.states = 0;     // of the worker, since another size was asked for
    this.wet = this.sucks = false;
  }
  begin({rpm, burr_mm}) {
    this.speed = rpm;
    this.size = burr_mm;
    this.states = 0;
  }
  // The servo has answered by now, or refused.
  seen(size_mm, wet) {
    if (this.states > 2) [this.size, this.wet] = [size_mm, wet];
    for (const [id, on] of [['coolant', this.wet], ['suction', this.sucks]]) document.getElementById(id).setAttribute('aria-pressed', String(on));
  }
  toggle_coolant() {
    this.wet = !this.wet;
    this.states = 0;
    this.host.command(Command.irrigation, this.wet ? 1 : 0);
    this.host.say(this.wet ? 'coolant_on' : 'coolant_off');
  }
  toggle_suction() {
    this.sucks = !this.sucks;
    this.host.suck(this.sucks);
    this.host.say(this.sucks ? 'suction_on' : 'suction_off');
  }

  // the servo refuses a burr of less than four voxels, and one for which there is no room
  resize(by) {
    const fitting = kSizes.filter((one) => one >= 4 * this.host.voxel() - 1e-9), {size} = this;
    const next = by < 0 ? fitting.findLast((one) => one < size - 0.01) : fitting.find((one) => one > size + 0.01);
    if (next === undefined) return;
    this.size = next;
    this.states = 0;
    this.host.command(Command.burr_radius, 0.5e-3 * next);
  }
  change_speed(by) {
    this.speed = Math.min(Math.max(kRpmMost, this.host.fastest()), Math.max(kRpmStep, this.speed + by * kRpmStep));
    this.host.command(Command.spindle_speed, this.speed * Math.PI / 30);
  }
  change_depth(by) {
    this.depth = Math.min(kMostDepth, Math.max(kLeastDepth, this.depth * kDepthStep ** by));
    document.getElementById('depth').textContent = words.number(this.depth, 1);
  }
}
