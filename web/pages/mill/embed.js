// The page inside of another one, of a school or a learning management system: it tells what happens here, and takes a few wishes. It talks
// to pages of its own host, or to the one host that the address names (?parent=https://school.example), and only where it is framed.
//
//     told    {burr: 1, kind: 'ready', case, mode, voxel_mm, language}, 'loaded' (it can be finished and marked now),
//             'figures' {time_s, force_n, removed_mm3} once a second,
//             'step' {id}, 'done' {time_s, removed_mm3}, 'marked' {score}, 'recording' {bytes, complete} or {why}, 'stopped' {why}
//     taken   {burr: 1, kind: 'open', case, mode}, 'language' {code}, 'finish', 'recording'
//
// `score` is what `burr score --json` says; in an exam there is none. docs/use/embedding.md is the table for users.
const kVersion = 1;
const kEvery = 1000;  // between figures [ms]

export class Embed {
  // host: open(case, mode), language(code), finish(), recording(), figures(), about()
  constructor(host) {
    this.host = host;
    this.wants = false;  // the page around asked for the recording
    this.told = '';      // the last figures
    if (window.parent === window) return;
    this.to = parent_origin();
    if (this.to === null) return;
    window.addEventListener('message', ({source, origin, data}) => {
      if (source === window.parent && origin === this.to && data?.burr === kVersion) this.take(data);
    });
    setInterval(() => this.tell_figures(), kEvery);
  }
  take({kind, ...what}) {
    if (kind === 'open') this.host.open(String(what.case ?? ''), String(what.mode ?? ''));
    else if (kind === 'language') this.host.language(String(what.code ?? ''));
    else if (kind === 'finish') this.host.finish();
    else if (kind === 'recording') {
      this.wants = true;
      if (!this.host.recording()) this.give({why: 'there is no session'});
    }
  }
  tell(kind, what = {}, transfer = []) {
    if (this.to) window.parent.postMessage({burr: kVersion, kind, ...what}, this.to, transfer);
  }
  tell_figures() {
    const figures = this.host.figures();
    if (!figures || JSON.stringify(figures) === this.told) return;
    this.told = JSON.stringify(figures);
    this.tell('figures', figures);
  }
  // The user has ended the session before the page around it got its recording: it gets the complete one.
  again() { if (this.wants) this.take({kind: 'recording'}); }
  // The recording has come. False: nobody around the page asked for it.
  give({file, complete, why}) {
    if (!this.wants) return false;
    this.wants = false;
    if (file) this.tell('recording', {bytes: file, complete}, [file.buffer]);
    else this.tell('recording', {why});
    return true;
  }
}

function parent_origin() {
  const named = new URLSearchParams(location.search).get('parent');
  if (named === null) return location.origin;
  try {
    const {origin, protocol} = new URL(named);
    return /^https?:$/.test(protocol) ? origin : null;
  } catch {
    return null;
  }
}
