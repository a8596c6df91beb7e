#!/usr/bin/env python3
"""letters.py OUT: writes the tables of letters_tables.h, of which burr reads names in other writing than UTF-8 and compares the
names of files: the character sets of DICOM (PS3.3 C.12.1.1.2), those of old zip archives, decomposed letters, small letters.

The tables are those of Python's own codecs and of its unicodedata. Called by cmake/letters.cmake.
"""
import sys
import unicodedata

NONE = 0xFFFD  # U+FFFD: no letter has this code
SINGLE = ["iso8859_1", "iso8859_2", "iso8859_3", "iso8859_4", "iso8859_5", "iso8859_6", "iso8859_7", "iso8859_8", "iso8859_9",
          "tis_620", "iso8859_15", "cp437"]


def letter(code: bytes, codec: str) -> int:
    try:
        text = code.decode(codec)
    except UnicodeDecodeError:
        return NONE
    return ord(text) if len(text) == 1 and ord(text) < 0x10000 else NONE


def square(codec: str, before: bytes = b"") -> list[int]:
    """The 94 rows of 94 letters of a set of ISO 2022, from its EUC form."""
    return [letter(before + bytes([0xA1 + row, 0xA1 + column]), codec) for row in range(94) for column in range(94)]


def japanese() -> list[int]:
    """JIS X 0208, and in its empty row 13 the signs that every Windows of Japan has there."""
    table = square("euc_jp")
    for column in range(94):
        lead, trail = 0x87, 0x40 + column + (1 if column >= 63 else 0)
        if table[12 * 94 + column] == NONE:
            table[12 * 94 + column] = letter(bytes([lead, trail]), "cp932")
    return table


def chinese() -> list[int]:
    """The two-byte letters of GB18030 (and GBK): lead 0x81..0xFE, trail 0x40..0xFE."""
    return [letter(bytes([lead, trail]), "gb18030") for lead in range(0x81, 0xFF) for trail in range(0x40, 0xFF)]


def decomposed() -> list[int]:
    """Triples: a letter, and the two that it is made of (the second 0 where it is one). Hangul is a formula."""
    out = []
    for code in range(0x10000):
        parts = unicodedata.decomposition(chr(code))
        if not parts or parts.startswith("<"):
            continue
        both = [int(part, 16) for part in parts.split()]
        if max(both) < 0x10000:
            out += [code, both[0], both[1] if len(both) > 1 else 0]
    return out


def marks() -> list[int]:
    """Pairs: a mark that is written over or under a letter, and its class, which orders several of them."""
    marked = [chr(code) for code in range(0x10000) if unicodedata.combining(chr(code))]
    return [number for mark in marked for number in (ord(mark), unicodedata.combining(mark))]


def small() -> list[int]:
    """Pairs: a capital letter and its small one."""
    out = []
    for code in range(0x80, 0x10000):
        other = chr(code).lower()
        if len(other) == 1 and other != chr(code) and ord(other) < 0x10000:
            out += [code, ord(other)]
    return out


def main() -> None:
    tables = {
        "kSingle": [letter(bytes([code]), codec) if code >= 0x80 else code for codec in SINGLE for code in range(0x80, 0x100)],
        "kJapanese": japanese(),
        "kJapaneseMore": square("euc_jp", b"\x8f"),
        "kKorean": square("euc_kr"),
        "kChineseSquare": square("gb2312"),
        "kChinese": chinese(),
        "kDecomposed": decomposed(),
        "kMarks": marks(),
        "kSmall": small(),
    }
    lines = ["// Made by scripts/letters.py of Python's codecs; letters.cpp says what is what.", "#pragma once", "#include <cstdint>",
             "namespace burr::io::letters {"]
    for name, table in tables.items():
        lines.append(f"inline constexpr std::uint16_t {name}[{len(table)}] = {{")
        lines += [",".join(map(str, table[at:at + 32])) + "," for at in range(0, len(table), 32)]
        lines.append("};")
    lines.append("}")
    with open(sys.argv[1], "w", encoding="ascii") as out:
        out.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main()
