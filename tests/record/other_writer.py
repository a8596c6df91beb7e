#!/usr/bin/env python3
"""other_writer.py IN OUT CHOICE... - writes a recording of burr again, as other writers of MCAP may.

It follows the specification (mcap.dev/spec) and shares no code with burr. Choices:
  channels_from_0     the numbers of channels begin with 0
  two_channels        each topic has two channels, used in turn
  no_chunks           messages stand in the data section
  chunk_bytes=N       a new chunk after N bytes, wherever that is
  chunk_per_topic     a topic's messages stand in chunks of their own
  in_order            messages in the order of their time
  zstd, lz4, stored   how chunks are packed; two_frames: as two frames of zstd
  schemas_in_chunks   schemas and channels stand in the chunks alone
  unknown             records of unknown kinds between all others
  no_summary, no_crc, no_chunk_index, no_message_index, no_summary_channels, shuffled_index
  huge=KIND           KIND of attachment, message, chunk, unknown: one of SIZE bytes, mostly a hole
  size=N              that SIZE
"""
import ctypes
import random
import struct
import subprocess
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
ZSTD = ctypes.CDLL("libzstd.so.1")
ZSTD.ZSTD_compressBound.restype = ZSTD.ZSTD_compress.restype = ZSTD.ZSTD_decompress.restype = ctypes.c_size_t
ZSTD.ZSTD_compressBound.argtypes = [ctypes.c_size_t]
ZSTD.ZSTD_compress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t, ctypes.c_int]
ZSTD.ZSTD_decompress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]


def zstd(data):
    room = ZSTD.ZSTD_compressBound(len(data))
    out = ctypes.create_string_buffer(room)
    size = ZSTD.ZSTD_compress(out, room, data, len(data), 3)
    return out.raw[:size]


def unzstd(data, size):
    out = ctypes.create_string_buffer(max(size, 1))
    assert ZSTD.ZSTD_decompress(out, size, data, len(data)) == size
    return out.raw[:size]


def text(value):
    return struct.pack("<I", len(value)) + value


def get_text(data, at):
    size = struct.unpack_from("<I", data, at)[0]
    return data[at + 4 : at + 4 + size], at + 4 + size


def record(kind, content):
    return struct.pack("<BQ", kind, len(content)) + content


def records(data, at, end):
    while at + 9 <= end:
        kind, size = struct.unpack_from("<BQ", data, at)
        if at + 9 + size > end:  # it is still being written
            return
        yield kind, data[at + 9 : at + 9 + size]
        at += 9 + size


class Recording:
    """What a recording holds, whatever its form."""

    def __init__(self, path):
        self.schemas, self.channels, self.metadata, self.attachments, self.messages = {}, {}, [], [], []
        self.path, self.at = path, len(MAGIC)
        self.go_on()

    def go_on(self):
        """Takes what was written since the last call."""
        with open(self.path, "rb") as file:
            file.seek(self.at)
            data = file.read()
        for kind, content in records(data, 0, len(data)):
            if kind == 0x0F:
                break
            self.take(kind, content)
            self.at += 9 + len(content)

    def take(self, kind, content):
        if kind == 0x03:
            self.schemas[struct.unpack_from("<H", content)[0]] = content[2:]
        elif kind == 0x04:
            number, schema = struct.unpack_from("<HH", content)
            self.channels[number] = (schema, content[4:])
        elif kind == 0x05:
            number, sequence, time, published = struct.unpack_from("<HIQQ", content)
            self.messages.append((number, sequence, time, published, content[22:]))
        elif kind == 0x06:
            size = struct.unpack_from("<Q", content, 16)[0]
            packing, at = get_text(content, 28)
            body = content[at + 8 :]
            inner = unzstd(body, size) if packing == b"zstd" else body
            for kind, content in records(inner, 0, len(inner)):
                self.take(kind, content)
        elif kind == 0x09:
            self.attachments.append(content)
        elif kind == 0x0C:
            self.metadata.append(content)


class Writer:
    def __init__(self, out, choices):
        self.out, self.choices, self.at = out, choices, 0
        self.chunks, self.attachments, self.metadata, self.counts = [], [], [], {}
        self.times = []
        self.noise = random.Random(7)
        self.known = set()

    def raw(self, data):
        self.out.write(data)
        self.at += len(data)

    def unknown(self):
        if "unknown" not in self.choices:
            return b""
        kind = self.noise.choice([0x10, 0x42, 0x7F, 0x80, 0xC5, 0xFF])
        return record(kind, self.noise.randbytes(self.noise.choice([0, 1, 9, 22, 200])))

    def put(self, kind, content):
        at = self.at
        self.raw(record(kind, content))
        self.raw(self.unknown())
        return at

    def hole(self, kind, head, size):
        """A record whose content is head and then zeros, which take no place on the disk."""
        at = self.at
        self.raw(struct.pack("<BQ", kind, size) + head)
        self.at = at + 9 + size
        self.out.seek(self.at)
        return at

    def describe(self, recording, numbers):
        """Schemas and channels for the messages of these channels."""
        out = b""
        for number in numbers:
            schema, content = recording.channels[number]
            if ("s", schema) not in self.known and schema in recording.schemas:
                out += record(0x03, struct.pack("<H", schema) + recording.schemas[schema]) + self.unknown()
                self.known.add(("s", schema))
            if ("c", number) not in self.known:
                out += record(0x04, struct.pack("<HH", number, schema) + content) + self.unknown()
                self.known.add(("c", number))
        return out

    def message(self, message):
        number, sequence, time, published, data = message
        self.counts[number] = self.counts.get(number, 0) + 1
        self.times.append(time)
        return record(0x05, struct.pack("<HIQQ", number, sequence, time, published) + data)

    def pack(self, data):
        for name in ("stored", "lz4", "two_frames"):
            if name in self.choices:
                break
        else:
            return b"zstd", zstd(data)
        if name == "stored":
            return b"", data
        if name == "two_frames":
            return b"zstd", zstd(data[: len(data) // 2]) + zstd(data[len(data) // 2 :])
        packed = subprocess.run(["lz4", "-c", "-q", *self.noise.choice([["-1"], ["-9", "-BD"], ["-BX", "-B4"], ["--content-size", "-B4"]])],
                                input=data, stdout=subprocess.PIPE, check=True).stdout
        return b"lz4", packed

    def chunk(self, recording, messages):
        if not messages:
            return
        data = b""
        if "schemas_in_chunks" in self.choices:
            data = self.describe(recording, {m[0] for m in messages})
        index = {}
        for message in messages:
            index.setdefault(message[0], []).append((message[2], len(data)))
            data += self.message(message) + self.unknown()
        start, end = min(m[2] for m in messages), max(m[2] for m in messages)
        packing, packed = self.pack(data)
        crc = 0 if "no_crc" in self.choices else zlib.crc32(data)
        head = struct.pack("<QQQI", start, end, len(data), crc) + text(packing) + struct.pack("<Q", len(packed))
        content = head + packed
        at = self.at
        self.raw(record(0x06, content))
        offsets, index_at = {}, self.at
        if "no_message_index" not in self.choices:
            for number, entries in index.items():
                offsets[number] = self.at
                body = b"".join(struct.pack("<QQ", *entry) for entry in entries)
                self.raw(record(0x07, struct.pack("<H", number) + text(body)))
        index_size = self.at - index_at
        self.raw(self.unknown())
        self.chunks.append((start, end, at, 9 + len(content), offsets, index_size, packing, len(packed), len(data)))

    def huge(self):
        size = int(next((c[5:] for c in self.choices if c.startswith("size=")), 5 << 30))
        if "huge=unknown" in self.choices:
            self.hole(0x90, b"", size)
        if "huge=attachment" in self.choices:
            head = struct.pack("<QQ", 0, 0) + text(b"somebody's film") + text(b"video/mp4") + struct.pack("<Q", size)
            at = self.hole(0x09, head, len(head) + size + 4)
            self.attachments.append((at, self.at - at, 0, 0, size, b"somebody's film", b"video/mp4"))
        message = struct.pack("<HIQQ", 999, 1, 5, 5)
        if "huge=message" in self.choices or "huge=chunk" in self.choices:
            content = struct.pack("<HH", 999, 0) + text(b"/film") + text(b"") + text(b"")
            self.put(0x04, content)
            self.counts[999] = 1
        if "huge=message" in self.choices:
            self.hole(0x05, message, size)
        if "huge=chunk" in self.choices:
            inner = struct.pack("<BQ", 0x05, size) + message
            head = struct.pack("<QQQI", 5, 5, 9 + size, 0) + text(b"") + struct.pack("<Q", 9 + size) + inner
            at = self.hole(0x06, head, len(head) - len(inner) + 9 + size)
            length, index_at = self.at - at, self.at
            self.raw(record(0x07, struct.pack("<H", 999) + text(struct.pack("<QQ", 5, 0))))
            self.chunks.append((5, 5, at, length, {999: index_at}, self.at - index_at, b"", 9 + size, 9 + size))

    def summary(self, recording):
        start = self.at
        out = self.unknown()
        if "no_summary_channels" not in self.choices:
            self.known = set()
            out += self.describe(recording, recording.channels)
        counts = b"".join(struct.pack("<HQ", *one) for one in self.counts.items())
        out += record(0x0B, struct.pack("<QHIIIIQQ", sum(self.counts.values()), len(recording.schemas),
                                        len(recording.channels), len(self.attachments), len(self.metadata),
                                        len(self.chunks), min(self.times), max(self.times)) + text(counts))
        if "no_chunk_index" not in self.choices:
            chunks = list(self.chunks)
            if "shuffled_index" in self.choices:
                self.noise.shuffle(chunks)
            for begin, end, at, length, offsets, index_size, packing, packed, size in chunks:
                places = b"".join(struct.pack("<HQ", *one) for one in offsets.items())
                out += record(0x08, struct.pack("<QQQQ", begin, end, at, length) + text(places) +
                              struct.pack("<Q", index_size) + text(packing) + struct.pack("<QQ", packed, size))
                out += self.unknown()
        for at, length, log, made, size, name, media in self.attachments:
            out += record(0x0A, struct.pack("<QQQQQ", at, length, log, made, size) + text(name) + text(media))
        for at, length, name in self.metadata:
            out += record(0x0D, struct.pack("<QQ", at, length) + text(name))
        self.raw(out)
        footer = struct.pack("<BQQQ", 0x02, 20, start, 0)
        crc = 0 if "no_crc" in self.choices else zlib.crc32(out + footer)
        self.raw(footer + struct.pack("<I", crc))


def changed(recording, choices):
    """The messages as they are to be written; the channels are changed too."""
    messages = recording.messages
    if "in_order" in choices:
        messages = sorted(messages, key=lambda m: m[2])
    if "channels_from_0" in choices:
        low = min(recording.channels)
        recording.channels = {n - low: c for n, c in recording.channels.items()}
        messages = [(m[0] - low, *m[1:]) for m in messages]
    if "two_channels" in choices:
        recording.channels.update({n + 500: c for n, c in list(recording.channels.items())})
        messages = [(m[0] + 500 * (n % 2), *m[1:]) for n, m in enumerate(messages)]
    return messages


def chunks_of(messages, choices):
    limit = int(next((c[12:] for c in choices if c.startswith("chunk_bytes=")), 50_000))
    if "chunk_per_topic" in choices:
        for number in sorted({m[0] for m in messages}, reverse=True):
            yield from chunks_of([m for m in messages if m[0] == number], choices - {"chunk_per_topic"})
        return
    chunk, size = [], 0
    for message in messages:
        chunk.append(message)
        size += len(message[4])
        if size >= limit:
            yield chunk
            chunk, size = [], 0
    yield chunk


def main(source, target, *words):
    choices = set(words)
    recording = Recording(source)
    messages = changed(recording, choices)
    with open(target, "wb") as out:
        writer = Writer(out, choices)
        writer.raw(MAGIC)
        writer.put(0x01, text(b"") + text(b"other_writer.py"))
        for content in recording.metadata:
            name, _ = get_text(content, 0)
            at = writer.put(0x0C, content)
            writer.metadata.append((at, 9 + len(content), name))
        if "schemas_in_chunks" not in choices:
            writer.raw(writer.describe(recording, recording.channels))
        writer.huge()
        for content in recording.attachments:
            log, made = struct.unpack_from("<QQ", content)
            name, at = get_text(content, 16)
            media, at = get_text(content, at)
            size = struct.unpack_from("<Q", content, at)[0]
            place = writer.put(0x09, content)
            writer.attachments.append((place, 9 + len(content), log, made, size, name, media))
        if "no_chunks" in choices:
            for message in messages:
                writer.raw(writer.message(message) + writer.unknown())
        else:
            for chunk in chunks_of(messages, choices):
                writer.chunk(recording, chunk)
        writer.put(0x0F, struct.pack("<I", 0))
        if "no_summary" in choices:
            writer.raw(record(0x02, struct.pack("<QQI", 0, 0, 0)))
        else:
            writer.summary(recording)
        writer.raw(MAGIC)


if __name__ == "__main__":
    main(*sys.argv[1:])
