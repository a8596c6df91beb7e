// The sound thread of the page: makes the samples by burr_sound, which sound.js has compiled. When no row has come for a while
// the page is busy or hidden, and the sound fades, as in the window (sound/voice.h).
const kSilentAfter = 0.5;  // [s]; a page without a graphics card draws three pictures a second

class BurrSound extends AudioWorkletProcessor {
  constructor({processorOptions}) {
    super();
    const none = new Proxy({}, {get: () => () => 0});  // what a program on a computer would be given
    const {exports} = new WebAssembly.Instance(processorOptions.compiled,
                                               {env: none, wasi_snapshot_preview1: none});
    exports._initialize?.();
    exports.sound_open(sampleRate, processorOptions.ticks_hz);
    this.burr = exports;
    this.loudness = 0;
    this.since = kSilentAfter;
    this.port.onmessage = ({data}) => {
      if (data.loudness !== undefined) this.loudness = data.loudness;
      if (data.to_spare !== undefined) exports.sound_near(data.to_spare, data.injured ? 1 : 0);
      if (data.row) {
        new Uint8Array(exports.memory.buffer, exports.sound_row(), data.row.length).set(data.row);
        exports.sound_update();
        this.since = 0;
      }
    };
  }
  process(_, [[out]]) {
    this.burr.sound_loudness(this.since < kSilentAfter ? this.loudness : 0);
    this.since += out.length / sampleRate;
    out.set(new Float32Array(this.burr.memory.buffer, this.burr.sound_make(out.length), out.length));
    return true;
  }
}

registerProcessor('burr-sound', BurrSound);
