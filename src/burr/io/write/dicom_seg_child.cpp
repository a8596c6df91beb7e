// Segmentation IOD as in PS3.3 A.51, by the library libdcmseg of DCMTK. Only burr-seg holds this file. The library of Debian
// 12 knows no label maps (Supplement 243): it makes a binary segmentation of the same slices, and what differs is changed.
#include "burr/io/write/dicom_seg_child.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmdata/dcspchrs.h>
#include <dcmtk/dcmfg/fgfracon.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>
#include <dcmtk/oflog/oflog.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace burr::io {
namespace {

using nlohmann::json;

void say(const std::string& line) {
  const std::string text = line + "\n";
  static_cast<void>(!::write(kSegMessages, text.data(), text.size()));
}

// A step of the library that failed ends the program with a sentence.
void demand(const OFCondition& done, const char* what) {
  if (done.bad()) throw std::runtime_error(std::string(what) + ": " + done.text());
}

// A number as DS, whose values have at most 16 letters, as exactly as fits.
OFString decimal(double value) {
  constexpr int kMost = 16, kDigits = 17;
  std::array<char, 64> text = {};
  for (int digits = kDigits; digits > 0; --digits) {
    const int size =
        std::snprintf(text.data(), text.size(), "%.*g", digits, value == 0 ? 0.0 : value);
    if (size > 0 && size <= kMost) break;
  }
  return text.data();
}

OFString text_of(const json& value) { return value.get<std::string>().c_str(); }

// With a meaning to be replaced: see add_texts().
CodeSequenceMacro code_of(const json& code) {
  return {text_of(code[0]), text_of(code[1]), "meaning"};
}

// The job, and where its labels lie.
struct Job {
  json header;
  const std::uint8_t* labels = nullptr;
  std::size_t columns = 0, rows = 0, slices = 0;

  [[nodiscard]] bool label_map() const { return header.at("kind") == "LABELMAP"; }
  [[nodiscard]] const std::uint8_t* slice(std::size_t k) const {
    return labels + k * rows * columns;
  }
};

Job read_job() {
  struct stat facts = {};
  if (::fstat(kSegJob, &facts) != 0 || facts.st_size < 8)
    throw std::runtime_error("burr-seg was told nothing");
  const auto size = static_cast<std::size_t>(facts.st_size);
  void* at = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, kSegJob, 0);
  if (at == MAP_FAILED) throw std::runtime_error("its memory cannot be read");
  const auto* bytes = static_cast<const std::uint8_t*>(at);
  std::uint64_t length = 0;
  std::memcpy(&length, bytes, sizeof length);
  if (length > size - sizeof length) throw std::runtime_error("burr-seg was told too little");
  Job job;
  job.header = json::from_cbor(bytes + sizeof length, bytes + sizeof length + length);
  job.labels = bytes + sizeof length + length;
  job.columns = job.header.at("size").at(0).get<std::size_t>();
  job.rows = job.header.at("size").at(1).get<std::size_t>();
  job.slices = job.header.at("size").at(2).get<std::size_t>();
  if (size - sizeof length - length != job.columns * job.rows * job.slices)
    throw std::runtime_error("burr-seg belongs to another version of burr; install burr again");
  return job;
}

std::unique_ptr<DcmSegmentation> empty_segmentation(const Job& job) {
  const OFString version = text_of(job.header["version"]);
  const IODGeneralEquipmentModule::EquipmentInfo equipment("burr", "burr", "none", version);
  const ContentIdentificationMacro content("1", "SEGMENTATION", "Labels written by burr", "");
  DcmSegmentation* made = nullptr;
  demand(DcmSegmentation::createBinarySegmentation(made, static_cast<Uint16>(job.rows),
                                                   static_cast<Uint16>(job.columns), equipment,
                                                   content),
         "a segmentation cannot be made");
  std::unique_ptr<DcmSegmentation> seg(made);
  const json& uids = job.header["uids"];
  demand(seg->getFrameOfReference().setFrameOfReferenceUID(text_of(uids["frame_of_reference"])),
         "the frame of reference of the scan is no UID");
  demand(seg->getSeries().setSeriesNumber("300"), "the number of the series");
  // before the first frame, or the library complains
  const OFString dimensions = text_of(uids["dimensions"]);
  IODMultiframeDimensionModule& module = seg->getDimensions();
  if (!job.label_map())
    demand(module.addDimensionIndex(DCM_ReferencedSegmentNumber, dimensions,
                                    DCM_SegmentIdentificationSequence, "Segment"),
           "the order of the frames");
  demand(module.addDimensionIndex(DCM_ImagePositionPatient, dimensions, DCM_PlanePositionSequence,
                                  "Slice"),
         "the order of the frames");
  return seg;
}

void add_geometry(const Job& job, DcmSegmentation& seg) {
  const json &spacing = job.header["spacing"], &axes = job.header["axes"];
  FGPixelMeasures measures;
  demand(measures.setPixelSpacing(decimal(spacing[1]) + "\\" + decimal(spacing[0])),
         "the distance of the voxels");
  demand(measures.setSliceThickness(decimal(spacing[2])), "the distance of the slices");
  demand(measures.setSpacingBetweenSlices(decimal(spacing[2])), "the distance of the slices");
  demand(seg.addForAllFrames(measures), "the distance of the voxels");
  std::unique_ptr<FGPlaneOrientationPatient> orientation(FGPlaneOrientationPatient::createMinimal(
      decimal(axes[0]), decimal(axes[1]), decimal(axes[2]), decimal(axes[3]), decimal(axes[4]),
      decimal(axes[5])));
  if (!orientation) throw std::runtime_error("the directions of the voxels");
  demand(seg.addForAllFrames(*orientation), "the directions of the voxels");
}

void add_segments(const Job& job, DcmSegmentation& seg) {
  const std::string by = job.header["by"].get<std::string>();
  const auto kind = by == "AUTOMATIC" ? DcmSegTypes::SAT_AUTOMATIC
                    : by == "MANUAL"  ? DcmSegTypes::SAT_MANUAL
                                      : DcmSegTypes::SAT_SEMIAUTOMATIC;
  const OFString algorithm = by == "MANUAL" ? "" : "name";
  for (const json& one : job.header["segments"]) {
    DcmSegment* segment = nullptr;
    demand(DcmSegment::create(segment, "name", code_of(one["category"]), code_of(one["type"]), kind,
                              algorithm),
           "a segment");
    const json& lab = one["lab"];
    demand(segment->setRecommendedDisplayCIELabValue(lab[0].get<Uint16>(), lab[1].get<Uint16>(),
                                                     lab[2].get<Uint16>()),
           "a colour");
    Uint16 number = 0;
    demand(seg.addSegment(segment, number), "a segment");
  }
}

// Which labels each slice has.
std::vector<std::array<bool, 256>> labels_of_slices(const Job& job) {
  std::vector<std::array<bool, 256>> has(job.slices);
  for (std::size_t k = 0; k < job.slices; ++k) {
    has[k].fill(false);
    const std::uint8_t* slice = job.slice(k);
    for (std::size_t n = 0; n < job.rows * job.columns; ++n) has[k][slice[n]] = true;
  }
  return has;
}

FGPlanePosPatient position_of(const Job& job, std::size_t k) {
  const json &axes = job.header["axes"], &origin = job.header["origin"];
  const double gap = job.header["spacing"][2].get<double>();
  std::array<OFString, 3> at;
  for (std::size_t a = 0; a < 3; ++a)
    at[a] =
        decimal(origin[a].get<double>() + gap * static_cast<double>(k) * axes[6 + a].get<double>());
  FGPlanePosPatient position;
  demand(position.setImagePositionPatient(at[0], at[1], at[2]), "the place of a frame");
  return position;
}

// Adds a frame. indices: its places along the dimensions.
void add_frame(DcmSegmentation& seg, FGPlanePosPatient position, std::vector<Uint8>& pixels,
               Uint16 segment, const std::vector<Uint32>& indices) {
  FGFrameContent content;
  for (std::size_t n = 0; n < indices.size(); ++n)
    demand(content.setDimensionIndexValues(indices[n], static_cast<Uint32>(n)), "a frame");
  OFVector<FGBase*> groups;
  groups.push_back(&position);
  groups.push_back(&content);
  demand(seg.addFrame(pixels.data(), segment, groups), "a frame");
}

std::size_t add_frames(const Job& job, DcmSegmentation& seg) {
  const json& segments = job.header["segments"];
  const auto has = labels_of_slices(job);
  std::vector<Uint32> place(job.slices, 0);  // among the slices with frames, from 1
  std::size_t all = 0;
  for (std::size_t k = 0, used = 0; k < job.slices; ++k) {
    std::size_t frames = 0;
    for (const json& one : segments) frames += has[k][one["value"].get<std::size_t>()] ? 1 : 0;
    all += frames;
    if (frames > 0) place[k] = static_cast<Uint32>(++used);
  }
  std::vector<Uint8> pixels(job.rows * job.columns);
  std::size_t done = 0;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const auto value = segments[s]["value"].get<std::uint8_t>();
    for (std::size_t k = 0; k < job.slices; ++k) {
      if (!has[k][value]) continue;
      const std::uint8_t* slice = job.slice(k);
      for (std::size_t n = 0; n < pixels.size(); ++n) pixels[n] = slice[n] == value ? 1 : 0;
      add_frame(seg, position_of(job, k), pixels, static_cast<Uint16>(s + 1),
                {static_cast<Uint32>(s + 1), place[k]});
      if (++done % 32 == 0)
        say("progress " +
            std::to_string(0.7 * static_cast<double>(done) / static_cast<double>(all)));
    }
  }
  return done;
}

// ---- label maps

// The first slice with a label, and how many up to the last one: one frame each, so that they lie evenly.
struct Planes {
  std::size_t first = 0, count = 0;
};

Planes add_planes(const Job& job, DcmSegmentation& seg) {
  Planes planes;
  const std::size_t slice = job.rows * job.columns;
  for (std::size_t k = 0; k < job.slices; ++k) {
    const std::uint8_t* from = job.slice(k);
    if (std::all_of(from, from + slice, [](std::uint8_t label) { return label == 0; })) continue;
    if (planes.count == 0) planes.first = k;
    planes.count = k + 1 - planes.first;
  }
  std::vector<Uint8> nothing(slice);  // the pixels follow in make_label_map()
  for (std::size_t n = 0; n < planes.count; ++n) {
    add_frame(seg, position_of(job, planes.first + n), nothing, 1, {static_cast<Uint32>(n + 1)});
    if (n % 32 == 0)
      say("progress " +
          std::to_string(0.7 * static_cast<double>(n) / static_cast<double>(planes.count)));
  }
  return planes;
}

// The background is a segment too, number 0, as a copy of the first one with its own name and code.
void add_background(DcmDataset& set) {
  DcmSequenceOfItems* sequence = nullptr;
  demand(set.findAndGetSequence(DCM_SegmentSequence, sequence), "the segments");
  auto background = std::make_unique<DcmItem>(*sequence->getItem(0));
  demand(background->putAndInsertUint16(DCM_SegmentNumber, 0), "the background");
  demand(background->putAndInsertString(DCM_SegmentLabel, "Background"), "the background");
  constexpr std::array<Uint16, 3> kBlack = {0, 0x8080, 0x8080};
  demand(background->putAndInsertUint16Array(DCM_RecommendedDisplayCIELabValue, kBlack.data(), 3),
         "the background");
  for (const DcmTagKey& tag :
       {DCM_SegmentedPropertyCategoryCodeSequence, DCM_SegmentedPropertyTypeCodeSequence}) {
    DcmItem* code = nullptr;
    demand(background->findAndGetSequenceItem(tag, code), "the background");
    demand(code->putAndInsertString(DCM_CodeValue, "125040"), "the background");
    demand(code->putAndInsertString(DCM_CodingSchemeDesignator, "DCM"), "the background");
    demand(code->putAndInsertString(DCM_CodeMeaning, "Background"), "the background");
  }
  demand(sequence->prepend(background.release()), "the background");
}

// Makes a Label Map Segmentation (PS3.3 C.8.20.2) of a binary one, whose segments have their names and codes.
void make_label_map(const Job& job, const Planes& planes, DcmDataset& set) {
  const auto number = [&](const DcmTagKey& tag, Uint16 value) {
    demand(set.putAndInsertUint16(tag, value), "the label map");
  };
  const auto text = [&](const DcmTagKey& tag, const char* value) {
    demand(set.putAndInsertString(tag, value), "the label map");
  };
  text(DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.7");
  text(DCM_SegmentationType, "LABELMAP");
  text(DCM_DimensionOrganizationType, "3D");
  number(DCM_BitsAllocated, 8);
  number(DCM_BitsStored, 8);
  number(DCM_HighBit, 7);
  number(DCM_PixelPaddingValue, 0);
  const json& segments = job.header["segments"];
  for (std::size_t n = 0; n < segments.size(); ++n) {
    DcmItem* item = nullptr;
    demand(set.findAndGetSequenceItem(DCM_SegmentSequence, item, static_cast<signed long>(n)),
           "a segment");
    demand(item->putAndInsertUint16(DCM_SegmentNumber, segments[n]["value"].get<Uint16>()),
           "a segment");
  }
  add_background(set);
  // which segment a frame shows is not stated: it shows all
  for (const DcmTagKey& groups :
       {DCM_SharedFunctionalGroupsSequence, DCM_PerFrameFunctionalGroupsSequence}) {
    DcmSequenceOfItems* sequence = nullptr;
    demand(set.findAndGetSequence(groups, sequence), "the frames");
    for (unsigned long n = 0; n < sequence->card(); ++n)
      sequence->getItem(n)->findAndDeleteElement(DCM_SegmentIdentificationSequence);
  }
  const std::size_t bytes = planes.count * job.rows * job.columns;
  constexpr std::size_t kMost = 0xFFFFFFFE;  // of one element
  if (bytes > kMost)
    throw std::runtime_error(
        "a label map of so many voxels is larger than a DICOM file can be; write .seg.nrrd, or "
        "fewer voxels (`voxel_mm`)");
  demand(set.putAndInsertUint8Array(DCM_PixelData, job.slice(planes.first),
                                    static_cast<unsigned long>(bytes)),
         "the pixels");
}

// The texts of the segments. The library takes all letters but those of ASCII for wrong, so it got others in their place.
void add_texts(const Job& job, DcmDataset& set) {
  const json& segments = job.header["segments"];
  for (std::size_t n = 0; n < segments.size(); ++n) {
    DcmItem* item = nullptr;
    demand(set.findAndGetSequenceItem(DCM_SegmentSequence, item, static_cast<signed long>(n)),
           "a segment");
    demand(item->putAndInsertString(DCM_SegmentLabel, text_of(segments[n]["name"]).c_str()),
           "the name of a segment");
    if (job.header["by"] != "MANUAL")
      demand(item->putAndInsertString(DCM_SegmentAlgorithmName,
                                      text_of(job.header["algorithm"]).c_str()),
             "the name of the method");
    for (const auto& [tag, what] :
         {std::pair{DCM_SegmentedPropertyCategoryCodeSequence, "category"},
          std::pair{DCM_SegmentedPropertyTypeCodeSequence, "type"}}) {
      DcmItem* code = nullptr;
      demand(item->findAndGetSequenceItem(tag, code), "a code");
      demand(code->putAndInsertString(DCM_CodeMeaning, text_of(segments[n][what][2]).c_str()),
             "a code");
    }
  }
}

// Patient and study, in UTF-8 as all other texts.
void add_study(const Job& job, DcmDataset& set) {
  demand(set.putAndInsertString(DCM_SpecificCharacterSet, "ISO_IR 192"), "the letters");
  const OFString letters = text_of(job.header["characters"]);
  DcmSpecificCharacterSet convert;
  const bool other = !letters.empty() && letters != "ISO_IR 192" && letters != "ISO_IR 6";
  if (other)
    demand(convert.selectCharacterSet(letters),
           "the letters of the scan's patient cannot be read; leave the patient out, by "
           "`io::SegOptions::study`");
  for (const json& one : job.header["study"]) {
    const auto tag = one[0].get<Uint32>();
    const auto raw = one[1].get<std::string>();
    OFString text(raw.data(), raw.size());
    // the letters ^ and = separate the parts of a name, and a backslash two values
    if (other)
      demand(convert.convertString(OFString(raw.data(), raw.size()), text, "\\^="),
             "the letters of the scan's patient cannot be read; leave the patient out, by "
             "`io::SegOptions::study`");
    demand(set.putAndInsertString(
               DcmTag(static_cast<Uint16>(tag >> 16), static_cast<Uint16>(tag & 0xFFFF)),
               text.c_str()),
           "what the scan states of its patient and study");
  }
}

void add_instance(const Job& job, DcmDataset& set) {
  const json& uids = job.header["uids"];
  const OFString date = text_of(job.header["date"]), time = text_of(job.header["time"]);
  const auto put = [&](const DcmTagKey& tag, const OFString& text) {
    demand(set.putAndInsertString(tag, text.c_str()), "what the file says of itself");
  };
  put(DCM_SOPInstanceUID, text_of(uids["instance"]));
  put(DCM_SeriesInstanceUID, text_of(uids["series"]));
  put(DCM_StudyInstanceUID, text_of(uids["study"]));
  put(DCM_FrameOfReferenceUID, text_of(uids["frame_of_reference"]));
  put(DCM_SeriesDescription, "Labels written by burr");
  put(DCM_ContentDate, date);
  put(DCM_ContentTime, time);
  put(DCM_SeriesDate, date);
  put(DCM_SeriesTime, time);
  put(DCM_InstanceCreationDate, date);
  put(DCM_InstanceCreationTime, time);
  put(DCM_SegmentsOverlap, "NO");
}

void write_file() {
  const Job job = read_job();
  auto seg = empty_segmentation(job);
  add_segments(job, *seg);
  add_geometry(job, *seg);
  Planes planes;
  if (job.label_map()) planes = add_planes(job, *seg);
  const std::size_t frames = job.label_map() ? planes.count : add_frames(job, *seg);
  // each frame is made above in the same way; to check thousands takes minutes
  seg->setCheckFGOnWrite(frames < 100 ? OFTrue : OFFalse);
  seg->setCheckDimensionsOnWrite(frames < 100 ? OFTrue : OFFalse);
  DcmFileFormat file;
  demand(seg->writeDataset(*file.getDataset()), "the segmentation is not complete");
  seg.reset();
  say("progress 0.85");
  add_texts(job, *file.getDataset());
  add_study(job, *file.getDataset());
  add_instance(job, *file.getDataset());
  if (job.label_map()) make_label_map(job, planes, *file.getDataset());
  demand(file.saveFile("-", EXS_LittleEndianExplicit), "the file cannot be written");
  if (std::fflush(stdout) != 0) throw std::runtime_error("the file cannot be written");
  say("frames " + std::to_string(frames));
}

}  // namespace

int write_one_segmentation() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Ctrl-C goes to every process at the terminal; the asker decides whether to stop
  for (const int number : {SIGINT, SIGQUIT, SIGHUP}) ::signal(number, SIG_IGN);
  ::signal(SIGPIPE, SIG_DFL);  // an asker that is gone needs nothing
  struct stat facts = {};
  if (::fstat(kSegMessages, &facts) != 0 || !S_ISFIFO(facts.st_mode)) {
    std::fputs("burr-seg writes DICOM segmentations for burr; do not start it by hand\n", stderr);
    return 2;
  }
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  try {
    if (!dcmDataDict.isDictionaryLoaded())
      throw std::runtime_error(
          "the names of DICOM's elements (dicom.dic of DCMTK) cannot be found; install its package "
          "again (Debian 12: libdcmtk17, Debian 13: dcmtk-data)");
    write_file();
  } catch (const std::bad_alloc&) {
    say("error there is too little memory for so many frames; write .seg.nrrd, or fewer voxels "
        "(`voxel_mm`)");
    return 1;
  } catch (const std::exception& problem) {
    say(std::string("error ") + problem.what());
    return 1;
  }
  ::_exit(0);  // the library may keep what it likes
}

}  // namespace burr::io
