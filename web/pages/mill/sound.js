// The sound of the drill on the page. It is off until the user switches it on, and quiet then.
import {compile} from '../common/burr.js';
import {word} from '../common/words.js';

const kQuiet = 0.25;  // of full scale

export class Sound {
  constructor() {
    this.on = false;
    this.loudness = kQuiet;
    this.trouble = '';
    this.context = this.node = null;
  }
  // Loads it, without a sound.
  async load() {
    try {
      this.compiled = await compile('burr_sound.wasm');
      this.context = new AudioContext({latencyHint: 'interactive'});
      if (!this.context.audioWorklet) throw new Error(word('no_sound'));
      await this.context.audioWorklet.addModule(new URL('sound_worklet.js', import.meta.url));
    } catch (what) {
      this.trouble = String(what?.message ?? what);
    }
  }
  // Call it in a gesture of the user: no browser lets a page sound before.
  async toggle(ticks_hz) {
    if (this.trouble || !this.context) return;
    this.on = !this.on;
    if (!this.node) {
      this.node = new AudioWorkletNode(this.context, 'burr-sound',
          {numberOfInputs: 0, outputChannelCount: [1], processorOptions: {compiled: this.compiled, ticks_hz}});
      this.node.connect(this.context.destination);
    }
    this.volume(this.loudness);
    await (this.on ? this.context.resume() : this.context.suspend());
  }
  // 0 to 1
  volume(loudness) {
    this.loudness = loudness;
    this.node?.port.postMessage({loudness: this.on ? loudness : 0});
  }
  // What watch.js found: how near what must not be cut is [m, or null], and whether the burr is in it.
  near(to_spare, injured) {
    if (this.on) this.node.port.postMessage({to_spare: to_spare ?? Infinity, injured});
  }
  // The newest row of the ticks.
  row(bytes) {
    if (this.on) this.node.port.postMessage({row: bytes});
  }
}
