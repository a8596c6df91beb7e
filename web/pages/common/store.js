// The sessions that this browser keeps, so that no reload and no crash loses them: each is a recording as far as it has come, and a few
// facts about it. They lie in the browser's own storage for this host (OPFS), or in IndexedDB where there is none; nobody else gets them.
//
//     const kept = await begin_kept(id, about, failed);    in a worker
//     kept.append(bytes); kept.note(about); ... await kept.close();
//     for (const {id, about, file} of await kept_sessions()) ...    anywhere
const kFolder = 'burr-sessions', kAbout = 512;  // bytes of the facts: always as many, so that they are written over in one piece
const kDatabase = 'burr-sessions';
const kTries = 5;                               // to read what is being written
const kSyncEvery = 1000;                        // to the disk, not only to the system [ms]

// failed(text): is called once, when the storage takes no more. null: there is no storage.
export async function begin_kept(id, about, failed) {
  let once = (what) => {
    once = () => {};
    failed(String(what?.name ?? what));
  };
  const fail = (what) => once(what);
  try {
    return await Files.begin(id, about, fail);
  } catch { /* no such storage here */ }
  try {
    return await Database.begin(id, about, fail);
  } catch (what) {
    fail(what);
    return null;
  }
}

// Newest first, and of one that was being brought back the longer one: [{id, about, bytes, file()}]. What cannot be read is left out.
export async function kept_sessions() {
  const found = [...await Files.list().catch(() => []), ...await Database.list().catch(() => [])];
  return found.sort((a, b) => b.about.begun - a.about.begun || b.about.ticks - a.about.ticks);
}
export async function forget_kept(id) {
  await Files.remove(id).catch(() => {});
  await Database.remove(id).catch(() => {});
}

const packed = (about) => new TextEncoder().encode(JSON.stringify(about).padEnd(kAbout, ' '));

// ---- files of the browser (OPFS)

async function folder() {
  const root = await navigator.storage.getDirectory();
  return root.getDirectoryHandle(kFolder, {create: true});
}

class Files {
  static async begin(id, about, failed) {
    const where = await folder(), one = new Files();
    one.failed = failed;
    const open = async (name) => (await where.getFileHandle(`${id}.${name}`, {create: true})).createSyncAccessHandle();
    one.facts = await open('json');
    try {
      one.recording = await open('mcap');
    } catch (what) {
      one.facts.close();
      throw what;
    }
    one.size = 0;
    one.synced = 0;
    one.note(about);
    return one;
  }
  append(bytes) {
    this.guard(() => {
      for (let done = 0; done < bytes.length;) {
        const written = this.recording.write(bytes.subarray(done), {at: this.size});
        if (!(written > 0)) throw new DOMException('', 'QuotaExceededError');
        done += written;
        this.size += written;
      }
      const now = performance.now();
      if (now - this.synced < kSyncEvery) return;
      this.synced = now;
      this.recording.flush();
    });
  }
  note(about) {
    this.guard(() => {
      this.facts.write(packed(about), {at: 0});
      this.facts.flush();
    });
  }
  guard(act) {
    if (this.ended) return;
    try {
      act();
    } catch (what) {
      this.ended = true;
      this.failed(what);
    }
  }
  async close() {
    this.ended = true;
    for (const one of [this.recording, this.facts]) {
      try {
        one.flush();
        one.close();
      } catch { /* it is closed */ }
    }
  }
  static async list() {
    const where = await folder(), all = [];
    for await (const [name, handle] of where.entries()) {
      if (!name.endsWith('.json')) continue;
      try {
        const id = name.slice(0, -5), about = await Files.facts_of(handle);
        const recording = await where.getFileHandle(`${id}.mcap`);
        all.push({id, about, bytes: (await recording.getFile()).size, file: () => recording.getFile()});
      } catch { /* it was never begun, or is being removed */ }
    }
    return all;
  }
  // Of a session that is being made: the file may be written between being opened and being read, and then cannot be read.
  static async facts_of(handle) {
    for (let tries = kTries;; --tries) {
      try {
        return JSON.parse(await (await handle.getFile()).text());
      } catch (what) {
        if (tries === 0) throw what;
      }
    }
  }
  static async remove(id) {
    const where = await folder();
    for (const name of ['mcap', 'json']) await where.removeEntry(`${id}.${name}`).catch(() => {});
  }
}

// ---- a database, where there are no files

const promised = (request) => new Promise((go, stop) => {
  request.onsuccess = () => go(request.result);
  request.onerror = () => stop(request.error);
});
async function database() {
  const opened = indexedDB.open(kDatabase, 1);
  opened.onupgradeneeded = () => {
    opened.result.createObjectStore('about', {keyPath: 'id'});
    opened.result.createObjectStore('parts', {keyPath: ['id', 'n']});
  };
  return promised(opened);
}
const parts_of = (id) => IDBKeyRange.bound([id, 0], [id, Infinity]);

class Database {
  static async begin(id, about, failed) {
    const one = new Database();
    Object.assign(one, {id, failed, store: await database(), n: 0});
    one.note(about);
    return one;
  }
  put(store, what) {
    if (this.ended) return;
    const act = this.store.transaction(store, 'readwrite', {durability: 'relaxed'});
    act.objectStore(store).put(what);
    act.onabort = () => {
      this.ended = true;
      this.failed(act.error);
    };
    this.last = new Promise((go) => { act.oncomplete = act.onerror = go; });
  }
  append(bytes) { this.put('parts', {id: this.id, n: this.n++, bytes: bytes.slice()}); }
  note(about) { this.put('about', {id: this.id, about}); }
  async close() {
    await this.last;
    this.ended = true;
    this.store.close();
  }
  static async list() {
    const store = await database();
    const all = await promised(store.transaction('about').objectStore('about').getAll());
    return Promise.all(all.map(async ({id, about}) => {
      const file = async () => new File((await promised(store.transaction('parts').objectStore('parts').getAll(parts_of(id)))).map((one) => one.bytes), 'burr.mcap');
      return {id, about, bytes: (await file()).size, file};
    }));
  }
  static async remove(id) {
    const act = (await database()).transaction(['about', 'parts'], 'readwrite');
    act.objectStore('about').delete(id);
    act.objectStore('parts').delete(parts_of(id));
    await new Promise((go) => { act.oncomplete = act.onabort = go; });
  }
}
