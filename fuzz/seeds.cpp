// fuzz_seeds DIR PROJECT [CORPUS]: writes small valid inputs of every kind, with which the fuzzers begin,
// to DIR/NAME/, with our own writers where we have them. Small files of a collection of test data
// (CORPUS), if it is there, are linked beside them.
#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "burr/io/write/write_volume.h"
#include "burr/record/bone_blob.h"
#include "burr/record/mcap/crc32.h"
#include "burr/record/mcap/mcap_writer.h"
#include "burr/record/mcap/packed.h"
#include "burr/record/recorder.h"
#include "burr/record/schema.h"
#include "burr/record/session_info.h"
#include "burr/scenario/case.h"
#include "burr/sim/session_words.h"
#include "burr/volume/bone.h"
#include "support.h"

namespace {

namespace fs = std::filesystem;
using namespace burr;
using record::BytesOut;
using std::string;

fs::path seeds, project;

void seed(const string& target, const string& name, const string& bytes) {
  fs::create_directories(seeds / target);
  std::ofstream file(seeds / target / name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  fuzz::must(file.good(), "a seed can be written");
}

string text(const BytesOut& out) { return string(record::as_text(out.span())); }

string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// window 31: gzip, 15: zlib, -15: deflate without header
string deflated(const string& bytes, int window) {
  z_stream stream{};
  fuzz::must(deflateInit2(&stream, 9, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) == Z_OK, "zlib");
  string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  std::vector<Bytef> in(bytes.begin(), bytes.end());
  stream.next_in = in.data();
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  fuzz::must(deflate(&stream, Z_FINISH) == Z_STREAM_END, "zlib packs");
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

string bzipped(string bytes) {
  string out(bytes.size() + 700, '\0');
  auto size = static_cast<unsigned>(out.size());
  fuzz::must(BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(),
                                      static_cast<unsigned>(bytes.size()), 9, 0, 0) == BZ_OK,
             "bzip2 packs");
  out.resize(size);
  return out;
}

string voxels(int count) {
  BytesOut out;
  for (int n = 0; n < count; ++n) out.put(static_cast<std::int16_t>(n * 37 - 1024));
  return text(out);
}

// ---- meshes

// A tetrahedron in each form; the first byte chooses the reader (mesh_fuzz.cpp).
void meshes() {
  const float places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::uint32_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  string words = "solid a\n", obj = "# a\n", lines;
  BytesOut stl, bytes;
  for (int n = 0; n < 20; ++n) stl.put(std::uint32_t{0});
  stl.put(std::uint32_t{4});
  for (const auto& p : places) {
    const string line =
        std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]);
    obj += "v " + line + "\n";
    lines += line + "\n";
    for (const float x : p) bytes.put(x);
  }
  for (const auto& f : faces) {
    words += "facet normal 0 0 0\nouter loop\n";
    obj += "f";
    lines += "3";
    bytes.put(std::uint8_t{3});
    for (int n = 0; n < 3; ++n) stl.put(0.0F);
    for (const std::uint32_t c : f) {
      words += "vertex " + std::to_string(places[c][0]) + " " + std::to_string(places[c][1]) + " " +
               std::to_string(places[c][2]) + "\n";
      obj += " " + std::to_string(c + 1) + "/1/1";
      lines += " " + std::to_string(c);
      bytes.put(c);
      for (const float x : places[c]) stl.put(x);
    }
    stl.put(std::uint16_t{0});
    words += "endloop\nendfacet\n";
    obj += "\n";
    lines += "\n";
  }
  const string head =
      " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 4\nproperty list uchar uint vertex_indices\nend_header\n";
  seed("mesh", "stl_text", "s" + words + "endsolid a\n");
  seed("mesh", "stl", "s" + text(stl));
  seed("mesh", "obj", "o" + obj + "f -1 -2 -3 -4\n");
  seed("mesh", "ply_text", "p" + ("ply\nformat ascii" + head) + lines);
  seed("mesh", "ply_little", "p" + ("ply\nformat binary_little_endian" + head) + text(bytes));
  seed("mesh", "ply_big", "p" + ("ply\nformat binary_big_endian" + head) + text(bytes));
}

// ---- scans

void nrrd() {
  const string head =
      "NRRD0005\n# a comment\ntype: short\ndimension: 3\nspace: left-posterior-superior\n"
      "sizes: 4 4 4\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.6)\nkinds: domain domain domain\n"
      "endian: little\nspace origin: (-1,2,3)\n";
  seed("nrrd", "raw", head + "encoding: raw\n\n" + voxels(64));
  seed("nrrd", "gzip", head + "encoding: gzip\n\n" + deflated(voxels(64), 31));
  seed("nrrd", "bzip2", head + "encoding: bzip2\n\n" + bzipped(voxels(64)));
  string numbers;
  for (int n = 0; n < 64; ++n) numbers += std::to_string(n * 1.5) + (n % 8 == 7 ? "\n" : ", ");
  seed("nrrd", "text", head + "encoding: text\n\n" + numbers);
  seed("nrrd", "skip", head + "encoding: raw\nbyte skip: -1\nline skip: 1\n\nx\n" + voxels(64));
  seed("nrrd", "skip_gzip",
       head + "encoding: gzip\nbyte skip: -1\n\n" + deflated("xyz" + voxels(64), 31));
  seed("nrrd", "own_data",
       head + "encoding: raw\nbyte skip: -1\ndata file: a.nrrd\n\n" + voxels(64));
  seed("nrrd", "list",
       head + "encoding: raw\nbyte skip: 9\ndata file: LIST\na.nrrd\na.nrrd\n\n" + voxels(64));
  seed("nrrd", "numbered", head + "encoding: raw\ndata file: a%01d.nrrd 1 4 1\n\n");
  seed("nrrd", "bare",
       "NRRD0001\ntype: float\ndimension: 4\nsizes: 1 4 4 4\nspacings: 1 0.5 0.5 2\nencoding: "
       "raw\nendian: big\nspace: right-anterior-superior\nspace units: \"cm\" \"cm\" \"cm\"\n\n" +
           voxels(128));
  seed("nrrd", "sheared",
       "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nspace: 3D-left-handed\nspace "
       "directions: none (1,0,0) (0,1,0) (0,0.3,1)\nencoding: raw\n\n" +
           voxels(64));
  const string segments =
      "Segment0_ID:=S1\nSegment0_Name:=Facial nerve\nSegment0_Color:=1 0.85 0\n"
      "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Extent:=0 7 0 7 0 7\n"
      "Segment1_Name:=Mandible\nSegment1_Color:=0.5 0.5 0.5\nSegment1_LabelValue:=2\n";
  string labels(512, '\0');
  for (std::size_t v = 0; v < labels.size(); ++v)
    labels[v] = static_cast<char>(v % 8 > 5 ? 0 : v > 256 ? 1 : 2);
  const string small =
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1)\n";
  seed("seg_nrrd", "raw", small + "encoding: raw\n" + segments + "\n" + labels);
  seed("seg_nrrd", "gzip", small + "encoding: gzip\n" + segments + "\n" + deflated(labels, 31));
  seed("seg_nrrd", "layers",
       "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 2 8 8 4\nkinds: list domain domain "
       "domain\nspace: left-posterior-superior\nspace directions: none (1,0,0) (0,1,0) "
       "(0,0,1)\nencoding: raw\n" +
           segments + "\n" + labels);
}

template <class T>
void put(string& bytes, std::size_t at, T value, bool big) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  if (big) std::reverse(raw.begin(), raw.end());
  std::copy(raw.begin(), raw.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

string nifti1(bool big, bool pair) {
  string head(352, '\0');
  put(head, 0, std::int32_t{348}, big);
  for (std::size_t a = 0; a < 8; ++a)
    put(head, 40 + 2 * a, static_cast<std::int16_t>(a == 0 ? 3 : a < 4 ? 4 : 1), big);
  put(head, 70, std::int16_t{4}, big);
  put(head, 72, std::int16_t{16}, big);
  for (std::size_t a = 0; a < 4; ++a) put(head, 76 + 4 * a, 1.0F, big);
  put(head, 108, pair ? 0.0F : 352.0F, big);
  put(head, 112, 2.0F, big);
  put(head, 116, -5.0F, big);
  head[123] = 2;
  put(head, 252, std::int16_t{1}, big);
  put(head, 254, std::int16_t{1}, big);
  put(head, 264, 0.3F, big);
  for (std::size_t a = 0; a < 3; ++a) put(head, 280 + 20 * a, 0.5F, big);
  head.replace(344, 4, pair ? string("ni1\0", 4) : string("n+1\0", 4));
  return head + voxels(64);
}

string nifti2(bool big) {
  string head(544, '\0');
  put(head, 0, std::int32_t{540}, big);
  head.replace(4, 8, string("n+2\0\r\n\032\n", 8));
  put(head, 12, std::int16_t{4}, big);
  for (std::size_t a = 0; a < 8; ++a)
    put(head, 16 + 8 * a, std::int64_t{a == 0 ? 3 : a < 4 ? 4 : 1}, big);
  for (std::size_t a = 0; a < 4; ++a) put(head, 104 + 8 * a, 1.0, big);
  put(head, 168, std::int64_t{544}, big);
  put(head, 344, std::int32_t{1}, big);
  put(head, 500, std::int32_t{2}, big);
  return head + voxels(64);
}

void nifti() {
  seed("nifti", "one", nifti1(false, false));
  seed("nifti", "big_endian", nifti1(true, false));
  seed("nifti", "pair", nifti1(false, true));
  seed("nifti", "two", nifti2(false));
  seed("nifti", "two_big_endian", nifti2(true));
  seed("nifti", "packed", deflated(nifti1(false, false), 31));
  seed("nifti", "packed_twice", deflated(deflated(nifti1(false, false), 31), 31));
  string names = nifti1(false, false);
  names[348] = 1;
  const string text = R"({"1": "bone", "2": "nerve"}     )";  // 32 bytes
  string extension(8, '\0');
  put(extension, 0, static_cast<std::int32_t>(8 + text.size()), false);
  names.insert(352, extension + text);
  put(names, 108, static_cast<float>(360 + text.size()), false);
  seed("nifti", "names", names);
}

void meta() {
  const string head =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = -10 5.5 0\nCenterOfRotation = 0 0 0\n"
      "ElementSpacing = 0.5 0.5 0.6\nDimSize = 4 4 4\nElementType = MET_SHORT\n";
  seed("meta", "local", head + "ElementDataFile = LOCAL\n" + voxels(64));
  seed("meta", "packed",
       head + "CompressedData = True\nElementDataFile = LOCAL\n" + deflated(voxels(64), 15));
  seed("meta", "own_data", head + "HeaderSize = -1\nElementDataFile = a.mhd\n" + voxels(64));
  seed("meta", "scaled",
       head +
           "ElementNumberOfChannels = 1\nElementToIntensityFunctionSlope = 2.5\n"
           "ElementToIntensityFunctionOffset = -100\nHeaderSize = 3\nElementDataFile = LOCAL\nxyz" +
           voxels(64));
}

// Writes elements of a DICOM data set.
class Dicom {
 public:
  bool explicit_vr = true, big = false;
  BytesOut out;

  void put16(std::uint32_t v) {
    const auto value = static_cast<std::uint16_t>(v);
    out.put(big ? static_cast<std::uint16_t>(value << 8 | value >> 8) : value);
  }
  void put32(std::uint32_t v) {
    put16(big ? v >> 16 : v);
    put16(big ? v : v >> 16);
  }
  void element(std::uint32_t tag, const char* vr, string value) {
    if (value.size() % 2 != 0) value += string(vr) == "UI" ? '\0' : ' ';
    head(tag, vr, static_cast<std::uint32_t>(value.size()));
    out.raw(record::as_bytes(value));
  }
  void number(std::uint32_t tag, std::uint32_t value) {
    head(tag, "US", 2);
    put16(value);
  }
  void head(std::uint32_t tag, const char* vr, std::uint32_t length) {
    put16(tag >> 16);
    put16(tag);
    const bool wide =
        string(vr) == "SQ" || string(vr) == "OW" || string(vr) == "OB" || string(vr) == "UN";
    if (explicit_vr) {
      out.raw(vr, 2);
      if (!wide) return put16(length);
      put16(0);
    }
    put32(length);
  }
  void mark(std::uint32_t tag, std::uint32_t length) {  // item, end of item, end of sequence
    put16(tag >> 16);
    put16(tag);
    put32(length);
  }
};

string dicom_set(bool explicit_vr, bool big, bool packed, bool enhanced) {
  Dicom d;
  d.explicit_vr = explicit_vr;
  d.big = big;
  d.element(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL");
  d.element(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2");
  d.element(0x00080060, "CS", "CT");
  d.head(0x00081140, "SQ", 0xFFFFFFFF);  // a sequence without length, with one item in it
  d.mark(0xFFFEE000, 0xFFFFFFFF);
  d.element(0x00081150, "UI", "1.2.3");
  d.mark(0xFFFEE00D, 0);
  d.mark(0xFFFEE0DD, 0);
  d.element(0x00180050, "DS", "1.5");
  d.element(0x0020000E, "UI", "1.2.3.4");
  d.element(0x00200013, "IS", "7");
  d.element(0x00200032, "DS", "-10\\-20.5\\3");
  d.element(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
  d.number(0x00280002, 1);
  d.element(0x00280004, "CS", "MONOCHROME2");
  if (enhanced) d.element(0x00280008, "IS", "2");
  d.number(0x00280010, 2);
  d.number(0x00280011, 3);
  d.element(0x00280030, "DS", "0.5\\0.5");
  d.number(0x00280100, 16);
  d.number(0x00280101, 12);
  d.number(0x00280102, 11);
  d.number(0x00280103, 0);
  d.number(0x00280120, 2000);
  d.element(0x00281052, "DS", "-1024");
  d.element(0x00281053, "DS", "1");
  if (enhanced) {
    for (const std::uint32_t sequence : {0x52009229U, 0x52009230U}) {
      d.head(sequence, "SQ", 0xFFFFFFFF);
      for (int frame = 0; frame < (sequence == 0x52009230U ? 2 : 1); ++frame) {
        d.mark(0xFFFEE000, 0xFFFFFFFF);
        d.head(0x00209113, "SQ", 0xFFFFFFFF);
        d.mark(0xFFFEE000, 0xFFFFFFFF);
        d.element(0x00200032, "DS", "0\\0\\" + std::to_string(frame * 2));
        d.mark(0xFFFEE00D, 0);
        d.mark(0xFFFEE0DD, 0);
        d.mark(0xFFFEE00D, 0);
      }
      d.mark(0xFFFEE0DD, 0);
    }
  }
  if (packed) {
    d.head(0x7FE00010, "OB", 0xFFFFFFFF);
    d.mark(0xFFFEE000, 0);
    d.mark(0xFFFEE000, 4);
    d.put32(0);
    d.mark(0xFFFEE0DD, 0);
  } else {
    d.head(0x7FE00010, "OW", enhanced ? 24 : 12);
    for (std::uint32_t n = 0; n < (enhanced ? 12U : 6U); ++n) d.put16(n * 300);
  }
  return text(d.out);
}

string dicom_file(const string& syntax, const string& set) {
  Dicom d;
  d.out.raw(record::as_bytes(string(128, '\0') + "DICM"));
  d.element(0x00020010, "UI", syntax);
  return text(d.out) + set;
}

void dicom() {
  const string uid = "1.2.840.10008.1.2";
  seed("dicom", "explicit", dicom_file(uid + ".1", dicom_set(true, false, false, false)));
  seed("dicom", "implicit", dicom_file(uid, dicom_set(false, false, false, false)));
  seed("dicom", "big_endian", dicom_file(uid + ".2", dicom_set(true, true, false, false)));
  seed("dicom", "deflated",
       dicom_file(uid + ".1.99", deflated(dicom_set(true, false, false, false), -15)));
  seed("dicom", "packed", dicom_file(uid + ".5", dicom_set(true, false, true, false)));
  seed("dicom", "enhanced", dicom_file(uid + ".1", dicom_set(true, false, false, true)));
  seed("dicom", "enhanced_implicit", dicom_file(uid, dicom_set(false, false, false, true)));
  seed("dicom", "ge_private",
       dicom_file("1.2.840.113619.5.2", dicom_set(false, false, false, false)));
  seed("dicom", "no_preamble", dicom_set(false, false, false, false));
  seed("dicom_series", "even", "p=0\\0\\0\nx\np=0\\0\\1.5\ni=2\nx\np=0\\0\\3\ni=3\n");
  seed("dicom_series", "tilted", "p=0\\0\\0\nx\np=0\\0.4\\1.5\nx\np=0\\0.8\\3\nx\np=0\\1.2\\4.5\n");
  seed("dicom_series", "uneven",
       "p=0\\0\\0\nx\np=0\\0\\1\nx\np=0\\0\\2\nx\np=0\\0\\3.3\nx\np=0\\0\\4\n");
  seed("dicom_series", "numbered", "p=\ni=1\nx\ni=3\nx\ni=2\nb=0.7\n");
  seed("dicom_series", "frames", "f=3\np=1\\2\\3\n");
  seed("dicom_series", "two", "u=1\ny=LOCALIZER\nx\nu=2\nk=B60\nx\np=0\\0\\2\nh=MONOCHROME1\n");
  seed("dicom_series", "phases",
       "a=1\np=0\\0\\0\nx\np=0\\0\\1\nx\np=0\\0\\2\nx\na=2\np=0\\0\\0\nx\np=0\\0\\1\nx\n"
       "p=0\\0\\2\n");
  seed("dicom_series", "times",
       "w=101000.5\np=0\\0\\0\nx\np=0\\0\\1\nx\nw=101001,5\np=0\\0\\0\nx\np=0\\0\\1\n");
  seed("dicom_series", "joined", "u=1.1\np=0\\0\\0\nx\nu=1.2\np=0\\0\\1\nx\nu=1.3\np=0\\0\\2\n");
  seed("dicom_series", "location", "l=0\nx\nl=1,5\nx\nl=3\n");
  seed("dicom_series", "blocks",
       "p=0\\0\\0\nx\np=0\\0\\1\nx\np=0\\0\\2\nx\np=0\\0\\90\nx\np=0\\0\\91\nx\np=0\\0\\92\n");
  seed("dicom_series", "oblique",
       "o=0.8\\0.6\\0\\-0.6\\0.8\\0\ns=0.3\\0.4\nx\np=0\\0\\2\nx\np=0\\0\\4\n");
  const string two = "a=1\nl=Bone\ne=91609006\nd=Mandible\nn\na=2\nl=Nerve\nh=abcdef\nn\n";
  seed("dicom_seg", "bits", two + "m=1\nf\np=0\\0\\1\nf\nm=2\np=0\\0\\3\nf\nx\n\x5A\xC3\x81\x7E");
  seed("dicom_seg", "fractions", two + "t=FRACTIONAL\nb=8\nv=200\nm=2\nf\nx\n\x10\x64\xC8\xFF");
  seed("dicom_seg", "label_map",
       "w=1.2.840.10008.5.1.4.1.1.66.7\nt=LABELMAP\nb=16\nq=7\n" + two + "f\np=0\\0\\1\nf\nx\n" +
           string("\1\0\7\0\2\1", 6));
  seed("dicom_contours", "square", "c\nd=1\\1\\2\\6\\1\\2\\6\\5\\2\\1\\5\\2\nc\ns\n");
  seed("dicom_contours", "leaning",
       "d=1\\1\\1\\6\\1\\2\\6\\5\\4\\1\\5\\3\nc\nd=1\\1\\2\\6\\1\\3\\6\\5\\5\\1\\5\\4\nc\ns\nn=2\n"
       "i=EXTERNAL\nh=255\\0\\9\nt=POINT\nd=1\\2\\3\nc\nt=CLOSEDPLANAR_XOR\nd="
       "4\\0\\0\\4\\6\\0\\4\\6\\5\nw=2\nc\ns\n");
  seed("dicom_seg", "silent", "f\np=0\\0.2\\1\nf\np=0\\0.4\\2\nf\nx\n\xFF\x0F");
}

// A description of AMBF, and pictures in the form of adf_fuzz.cpp.
void adf() {
  const string text =
      "# AMBF Version: (0.1)\nvolumes: [VOLUME a]\nVOLUME a:\n  scale: 1.0\n"
      "  dimensions: {x: 0.1, y: 0.1, z: 0.2}\n  images:\n    path: p/\n    prefix: a\n"
      "    format: png\n    count: 3\n...\n";
  const auto picture = [](char kind, char depth, const string& raw) {
    return string{kind, depth, '\0', '\1', '\1'} + static_cast<char>(raw.size()) + raw;
  };
  const string row("\0\xFF\xF9\xDB\xFF\0\0\0\0", 9), sum("\0\xF3\xCF\x0C\xFE\xF4\xD6\x31\xFF", 9);
  seed("adf", "colours", text + picture(6, 8, row + row) + picture(6, 8, row + sum));
  seed("adf", "greys", text + picture(0, 8, string("\0\1\2\0\3\4", 6)));
  seed("adf", "palette", text + picture(3, 8, string("\0\0\1\0\1\0", 6)));
  seed("adf", "alias", "volumes: &x [VOLUME a]\nVOLUME a: *x\nd: {e: [f, {g: h}]}\n...\n");
}

// Pictures of a stack: TIFF of 3 x 2 pixels, of 8 or 16 bits, and BMP.
string tiff_page(std::size_t bits, const string& description, std::uint32_t pages) {
  Dicom d;  // for its little-endian numbers
  d.out.raw(record::as_bytes(string("II*\0", 4)));
  d.put32(8);
  const std::size_t bytes = 6 * bits / 8;
  for (std::uint32_t page = 0; page < pages; ++page) {
    constexpr std::uint32_t kTags = 9, kEach = 12;
    const auto here = static_cast<std::uint32_t>(d.out.span().size());
    const std::uint32_t end = here + 2 + kEach * kTags + 4;
    const auto words = static_cast<std::uint32_t>(description.size());
    d.put16(kTags);
    const std::uint32_t fields[kTags][4] = {
        {256, 3, 1, 3},           {257, 3, 1, 2}, {258, 3, 1, static_cast<std::uint32_t>(bits)},
        {259, 3, 1, 1},           {262, 3, 1, 1}, {270, 2, words, end},
        {273, 4, 1, end + words}, {278, 3, 1, 2}, {279, 4, 1, static_cast<std::uint32_t>(bytes)}};
    for (const auto& field : fields) {
      d.put16(field[0]);
      d.put16(field[1]);
      d.put32(field[2]);
      d.put32(field[3]);
    }
    d.put32(page + 1 < pages ? end + words + static_cast<std::uint32_t>(bytes) : 0);
    d.out.raw(record::as_bytes(description + string(bytes, static_cast<char>(page + 1))));
  }
  return text(d.out);
}

void pictures() {
  using namespace std::string_literals;
  const string imagej =
      "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\nunit=mm\nspacing=2\ncf=0\nc0=-9\nc1=1\n\0"s;
  const string ome =
      "<OME><Pixels DimensionOrder=\"XYZCT\" PhysicalSizeX=\"5\" PhysicalSizeY=\"5\" "
      "SizeZ=\"3\"/>\0"s;
  seed("tiff", "pages", tiff_page(16, string("x\0", 2), 3));
  seed("tiff", "imagej", tiff_page(8, imagej, 4));
  seed("tiff", "ome", tiff_page(16, ome, 3));
  string bmp =
      "BM" + string(8, '\0') + string("\x36\0\0\0\x28\0\0\0\3\0\0\0\2\0\0\0\1\0\x18\0", 20);
  bmp += string(54 - bmp.size(), '\0') + string(24, '\7');
  const auto one = [](const string& name, const string& bytes) {
    return name + "\n" + static_cast<char>(bytes.size() & 0xFF) +
           static_cast<char>(bytes.size() >> 8) + bytes;
  };
  const string page = tiff_page(16, string("x\0", 2), 1);
  seed("picture_stack", "tiff", one("s1.tif", page) + one("s2.tif", page) + one("s10.tif", page));
  seed("picture_stack", "bmp", one("a_1.bmp", bmp) + one("a_3.bmp", bmp));
  seed("letters", "japan", "\\ISO 2022 IR 87\nJAW.RAW\n\x1B$B;3ED\x1B(B^\x1B$BB@O:\x1B(B");
  seed("letters", "windows", "ISO_IR 13\n\x83\x5C.raw\n\xE3\x82\xBD.raw");
  seed("letters", "china", "GB18030\nZ\xE4hne\n\xCD\xF5^\xD0\xA1");
}

// A zip archive of one file.
string zipped(const string& name, const string& content, bool deflate_it) {
  const string packed = deflate_it ? deflated(content, -15) : content;
  Dicom d;  // for its little-endian numbers
  const auto facts = [&] {
    d.put16(deflate_it ? 8 : 0);
    d.put32(0);  // time
    d.put32(static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(content.data()),
                                             static_cast<uInt>(content.size()))));
    d.put32(static_cast<std::uint32_t>(packed.size()));
    d.put32(static_cast<std::uint32_t>(content.size()));
    d.put16(static_cast<std::uint32_t>(name.size()));
    d.put16(0);
  };
  d.put32(0x04034B50);
  d.put16(20);
  d.put16(0);
  facts();
  d.out.raw(record::as_bytes(name + packed));
  const auto table = static_cast<std::uint32_t>(30 + name.size() + packed.size());
  d.put32(0x02014B50);
  d.put32(20U << 16 | 20U);
  d.put16(0);
  facts();
  for (int n = 0; n < 7; ++n) d.put16(0);
  d.out.raw(record::as_bytes(name));
  d.put32(0x06054B50);
  d.put32(0);
  d.put32(1U << 16 | 1U);
  d.put32(static_cast<std::uint32_t>(46 + name.size()));
  d.put32(table);
  d.put16(0);
  return text(d.out);
}

void unpacking() {
  seed("zip", "stored", zipped("a.raw", voxels(20), false));
  seed("zip", "deflated", zipped("ct/b.raw", voxels(300), true));
  seed("zip", "way_out", zipped("../b.raw", voxels(20), true));
  const string bytes = voxels(300);
  seed("unpack", "gzip", '\x50' + deflated(bytes, 31));
  seed("unpack", "gzip_twice", '\x50' + deflated(bytes, 31) + deflated(bytes, 31) + "junk");
  seed("unpack", "zlib", '\x51' + deflated(bytes, 15));
  seed("unpack", "bare", '\x52' + deflated(bytes, -15));
  seed("unpack", "bzip2", '\x53' + bzipped(bytes));
  record::Packer packer;
  std::vector<std::uint8_t> packed;
  packer.pack(record::as_bytes(bytes), packed);
  seed("unpack", "zstd", string("\x04\x58\x02") + string(packed.begin(), packed.end()));
}

// ---- texts

void texts() {
  seed("tissues", "all",
       "[[label]]\nvalue = 1\nname = \"facial nerve\"\nkind = \"soft\"\nspare = true\ncolour = [1, "
       "0.9, 0.1]\n\n[[label]]\nname = \"bone\"\nkind = \"solid\"\ncutting_energy_J_mm3 = "
       "1.5\nfriction = 0.3\n\n[[label]]\nvalue = 3\nkind = \"air\"\n");
  seed("tissues", "inline", "label = [ { value = 2, name = 'x' }, { value = 0x03 } ]\n");
  seed("case", "file",
       "title = \"A\"\ndescription = \"\"\"\ntwo\nlines\"\"\"\nvolume = \"bone.nrrd\"\nvoxel_mm = "
       "0.5\n[work]\nat_mm = [1, 2.5, -3]\ninto = [0, 0, -1]\n[burr]\ndiameter_mm = 4\nkind = "
       "\"diamond\"\nrpm = 40_000\n[demo]\nmotion = \"pocket\"\nseconds = 20\n[[spare]]\ntissue = "
       "\"bone\"\n[[target]]\ntissue = \"bone\"\ngoal = \"open\"\nshare = 0.5\n");
  for (const fs::directory_entry& entry : fs::directory_iterator(project / "cases"))
    seed("case", entry.path().filename().string(), content(entry.path()));
  seed("label_lists", "xml",
       "<LabelTable><Label Key=\"1\" Red=\"1\" Green=\"0.5\" Blue=\"0\" "
       "Alpha=\"1\"><![CDATA[nerve]]>"
       "</Label><Label Key='2'>bone &amp; tooth</Label></LabelTable>");
  seed("label_lists", "json",
       R"({"labels": {"1": "bone", "2": {"name": "nerve"}}, "more": [{"name": "x", "label": 3}]})");
  seed("label_lists", "snap", "# list\n1 255 0 0 1 1 1 \"Nervus facialis\"\n");
  seed("label_lists", "free", "16 Brain-Stem 119 159 176 0\n");
  seed("materials", "built_in", content(project / "materials/materials.toml"));
  seed("materials", "own",
       "[[material]]\nname = \"Enamel\"\nfriction = { value = 0.3, low = 0, high = 2, source = "
       "\"a bench\", calibrated = true }\n[[material]]\nname = 'x'\nlike = 'cement'\n");
  seed("force_log", "all",
       "# a bench\ntime_s,normal_n,tangential_n,rpm,radius_mm,removal_mm3_s,power_w,edge_mm,"
       "material\n0,1,0.4,40000,2,3,3.3,0.5,bone\n0.1,2,0.9,40000,2,7,6.8,0.7,bone\n0.2,3,1.1,"
       "30000,2,9,7,0.4,bone\n0.3,4,1.7,20000,2,8,6.6,1.1,bone\n0.4,0,0,0,2,0,0,0,\n");
  seed("force_log", "few",
       "removal_mm3_s, rpm, radius_mm, time_s, tangential_n, normal_n\r\n1,1e4,1,0,.1,.2\r\n");
  seed("hand_path", "metres", "t,x,y,z\n0,0,0,0.01\n0.5,0,0,0\n1,1e-3,-2e-3,0\n");
  seed("hand_path", "all",
       "t,x_mm,y_mm,z_mm,qw,qx,qy,qz,spindle\r\n0,0,0,1,1,0,0,0,1\r\n0.1,0,0,.5,0,1,0,0,0\r\n");
}

// ---- recordings

std::unique_ptr<volume::Bone> block(int edge) {
  volume::Grid grid;
  grid.size = {edge, edge, edge};
  grid.voxel = 0.5e-3;
  const auto count = static_cast<std::size_t>(edge * edge * edge);
  std::vector<volume::Field> field(count);
  const std::vector<volume::TissueId> tissue(count, 1);
  for (std::size_t v = 0; v < count; ++v)
    field[v] = volume::field_from_depth(0.4 * edge - static_cast<double>(v) / (edge * edge));
  return volume::bone_from_arrays(grid, {}, field, tissue, {}, 4);
}

record::SessionInfo session_of(const volume::Bone& bone) {
  record::SessionInfo info;
  sim::describe(sim::SessionSettings{}, {}, info);
  info.words["motion"] = "pocket";
  info.volume.content_hash = bone.content_hash();
  info.volume.source_fingerprint = 0x123456789ABCDEF0;
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  info.volume.recipe.reserve_bricks = 4;
  info.volume.format = "NRRD";
  info.volume.recipe.voxel_mm = 0.5;
  return info;
}

// a container with one record of every kind; chunks compressed or not
string container(bool packed, bool finished) {
  const string path = fuzz::folder() + "/seed.mcap";
  record::McapWriter writer;
  const auto good = [](bool holds) { fuzz::must(holds, "a container can be written"); };
  good(writer.open(path, path).ok());
  const auto schema = writer.add_schema("burr.Session", "jsonschema", "{}");
  const auto ticks = writer.add_channel("/ticks", "protobuf", *schema);
  const auto session = writer.add_channel("/session", "json", *schema);
  good(writer.add_metadata("burr", {{"format", "1"}}).ok());
  good(writer.add_attachment("bone", "application/x-burr-bone", record::as_bytes("BURRBON1")).ok());
  const string info = record::to_json(session_of(*block(8)));
  std::vector<tick::TickRow> rows(2);
  BytesOut columns;
  record::encode_ticks(rows, columns);
  if (packed) {
    writer.add_message(*session, 0, 0, record::as_bytes(info));
    writer.add_message(*ticks, 0, 1'000'000, columns.span());
    good(writer.close_chunk().ok());
    writer.add_message(*ticks, 1, 2'000'000, columns.span());
    good(writer.close_chunk().ok());
  } else {
    BytesOut chunk, message;
    record::mcap::MessageIndexes indexes;
    for (const auto& [channel, data] :
         {std::pair{*session, record::as_bytes(info)}, std::pair{*ticks, columns.span()}}) {
      message.clear();
      message.put(channel);
      message.put(std::uint32_t{0});
      message.put(std::uint64_t{0});
      message.put(std::uint64_t{0});
      message.raw(data);
      indexes[channel].emplace_back(0, chunk.size());
      record::mcap::put_record(chunk, record::mcap::Kind::message, message.span());
    }
    record::mcap::ChunkAt at;
    at.packed_size = at.unpacked_size = chunk.size();
    good(writer.add_chunk(at, record::crc32(chunk.span()), chunk.span(), indexes).ok());
  }
  if (finished) good(writer.finish().ok());
  return content(path);
}

// messages of devices, and settings for them
void devices() {
  const string first =
      R"({"session_id":7,"inverse3":[{"device_id":"049D","config":{"type":"inverse3",)"
      R"("handedness":"left","device_info":{"major_version":7,"minor_version":4}},"state":)"
      R"({"cursor_position":{"x":0.01,"y":-0.02,"z":0.03},"cursor_velocity":{"x":0,"y":0,"z":0},)"
      R"("current_cursor_force":{"x":0,"y":0,"z":0}},"status":{"calibrated":true,"in_use":false,)"
      R"("power_supply":true,"ready":true}}],"wireless_verse_grip":[{"device_id":"GRIP","state":)"
      R"({"orientation":{"w":1,"x":0,"y":0,"z":0},"buttons":{"a":true,"button_1":true},)"
      R"("battery_level":0.8},"status":{"connected":true,"awake":true}}]})";
  seed("haply_message", "states",
       first + "\n" + R"({"inverse3":[{"device_id":"049D","state":{}}],"verse_grip":[]})" + "\n" +
           R"({"inverse3":[]})");
  seed("haply_message", "version", R"({"ok":true,"data":{"project_version":"3.5.0"}})");
  seed("haply_message", "events",
       R"({"name":"device-safety-triggered","category":"device","level":"critical","data":)"
       R"({"device_id":"049D","safety_type":"ebrake_triggered"},"message":"x"})"
       "\n"
       R"({"name":"device-battery-low","level":"warning","data":{"device_id":"GRIP"}})");
  const string line = "0.0 10.5 -3.25 0.1 -0.2 0.3 0.0 0";
  const string whole = line + string(63 - line.size(), ' ') + "\n";
  seed("polhem_line", "line", line);
  seed("polhem_line", "whole", '\x0d' + whole + '\x0d' + whole);
  seed("polhem_line", "pieces", '\x02' + whole.substr(0, 11) + '\x0c' + whole.substr(11) + '\xff');
  seed("device_book", "usual",
       "scale=0.5\n[\"Touch T-1\"]\nscale = 2\nmax_force_n = 1.5\ndead_man = true\naxes = \"far "
       "left up\"\n[\"CRTK arm /MTMR\"]\nmill_button = 1\nclutch_button = -1\nvibration = 0.5\n"
       "torque = 0\n");
  seed("device_book", "axes", "axes=right up near\n");
}

string recorded() {
  const string path = fuzz::folder() + "/seed.mcap";
  const auto bone = block(8);
  record::Recorder recorder(1000);
  fuzz::must(recorder.start(path, session_of(*bone), bone.get()).ok(), "a session is recorded");
  for (std::uint64_t tick = 0; tick < 3; ++tick) {
    tick::TickRow row;
    row.tick = tick;
    fuzz::must(recorder.ticks().push(row), "a tick is taken");
  }
  fuzz::must(recorder.finish().ok(), "a recording is finished");
  return content(path);
}

void recordings() {
  const auto bone = block(8);
  seed("session", "usual", record::to_json(session_of(*bone)));
  const auto blob = record::bone_to_blob(*block(16));
  seed("bone_blob", "as_it_is", '\x10' + string(blob.begin(), blob.end()));
  const std::uint8_t* length = blob.data() + 8;
  std::uint32_t head = 0;
  std::memcpy(&head, length, sizeof head);
  const string json(blob.begin() + 12, blob.begin() + 12 + head);
  string bricks = "\x02";
  bricks += string("\x00\x00\x07\x00", 4) + string(2048, '\x55') + "\x01";
  seed("bone_blob", "made", '\x11' + json + "\n" + bricks);
  const string whole = container(true, true);
  seed("mcap", "packed", whole);
  seed("mcap", "plain", container(false, true));
  seed("mcap", "not_finished", container(false, false));
  seed("mcap", "torn", whole.substr(0, whole.size() / 2));
  seed("mcap", "recorded", recorded());
  // bytes in the form of player_fuzz.cpp: a session, ticks, commands, bricks, chunks
  seed("player", "usual",
       string("\x00\x00\x06\x01\x04\x00\x00\x00\x00\x06\x01\x02\x00\x00\x06", 15));
  seed(
      "player", "moves",
      string("\x00\x01\x05\x03\x06\x01\x03\x01\xBF\x10\x00\xBF\x20\x00\xBF\x40\x00\x08\x01\x00\x06",
             21));
  seed("player", "bricks",
       string("\x00\x00\x06\x04\x01\x00\x01\x01\x00\x01\x00\xFF\x80\x01\x01\x06\x05\x01\x00\x01\x00"
              "\x06",
              22));
  // a view, and an event of the course
  seed("player", "notes",
       string("\x00\x00\x06\x20\x01\x01\x02\x03\x01\x00\x01\x21\x02\x00\x03one\x00\x00\x06", 22));
  seed("player", "wishes",
       string("\x00\x00\x02\x00\x00\x01\x02\x05\x01\x00\x07\x01\x03\x00\x00\x00\x03\x01\x06", 19));
}

void link_small(const fs::path& corpus, const string& target, const std::vector<string>& folders) {
  constexpr std::uintmax_t kSmall = 16384;
  for (const string& folder : folders) {
    std::error_code trouble;
    for (fs::recursive_directory_iterator at(corpus / folder, trouble), end; !trouble && at != end;
         at.increment(trouble)) {
      if (!at->is_regular_file(trouble) || at->file_size(trouble) > kSmall) continue;
      string name = fs::relative(at->path(), corpus).string();
      std::replace(name.begin(), name.end(), '/', '_');
      fs::create_symlink(fs::absolute(at->path()), seeds / target / name, trouble);
      trouble.clear();
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(
        stderr,
        "usage: fuzz_seeds DIR PROJECT [CORPUS]      (PROJECT: the folder of burr's sources)\n");
    return 2;
  }
  seeds = argv[1];
  project = argv[2];
  fs::remove_all(seeds);
  nrrd();
  nifti();
  meta();
  meshes();
  dicom();
  adf();
  pictures();
  unpacking();
  texts();
  devices();
  recordings();
  if (argc == 4) {
    const fs::path corpus = argv[3];
    link_small(corpus, "nrrd", {"nrrd", "derived/nrrd"});
    link_small(corpus, "seg_nrrd", {"nrrd"});
    link_small(corpus, "nifti", {"nifti", "derived/nifti"});
    link_small(corpus, "meta", {"metaimage", "derived/metaimage"});
    link_small(corpus, "dicom", {"dicom", "derived/dicom"});
  }
  for (const fs::directory_entry& target : fs::directory_iterator(seeds))
    std::printf("%s: %zu\n", target.path().filename().c_str(),
                static_cast<std::size_t>(std::distance(fs::directory_iterator(target), {})));
  return 0;
}
