// record/session_schema.cpp - the JSON Schema of /session: what a session was. A field is added here and in
// session_info.cpp.
#include "burr/record/schema_parts.h"

namespace burr::record {
namespace {

constexpr const char* kSessionSchema = R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.Session",
 "description": "What the session was, before the first tick; once more for each time that it was continued.",
 "type": "object",
 "properties": {
  "burr_version": {"type": "string"},
  "build": {"type": "string", "description": "compiler and kind; replay is to the bit on the same build"},
  "rate_hz": {"type": "number", "description": "ticks per second"},
  "seed": {"type": "string", "description": "hexadecimal, 64 bit"},
  "numbers": {"type": "object", "description": "settings; units are in the names", "additionalProperties": {"type": "number"}},
  "words": {"type": "object", "description": "settings in words", "additionalProperties": {"type": "string"}},
  "embedded": {"type": "boolean", "description": "the bone is in the attachment \"bone\""},
  "volume": {
   "type": "object",
   "description": "the bone the session began with",
   "properties": {
    "content_hash": {"type": "string", "description": "hexadecimal, of the bone before the first tick"},
    "source_fingerprint": {"type": "string", "description": "hexadecimal, of the file or folder it was read from; 0 if none"},
    "grid": {
     "type": "object",
     "properties": {
      "size": {"type": "array", "items": {"type": "integer"}, "description": "voxels along i, j, k"},
      "voxel_m": {"type": "number", "description": "edge of a voxel [m]"},
      "origin_m": {"type": "array", "items": {"type": "number"}, "description": "centre of voxel 0,0,0 in LPS [m]"},
      "axes_xyzw": {"type": "array", "items": {"type": "number"}, "description": "world_from_grid as a unit quaternion"}
     }
    },
    "tissues": {
     "type": "array",
     "description": "index is the tissue id of a voxel",
     "items": {
      "type": "object",
      "properties": {
       "name": {"type": "string"},
       "kind": {"enum": ["air", "soft", "solid"]},
       "colour_srgb": {"type": "array", "items": {"type": "number"}, "description": "0..1"},
       "cutting_energy_j_per_m3": {"type": "number", "description": "specific cutting energy [J/m^3]"},
       "friction": {"type": "number", "description": "of a standing burr"},
       "cutting_friction": {"type": "number", "description": "tangential over normal force of a cut"},
       "cutting_force": {"type": "object", "description": "of the chips law", "additionalProperties": {"type": "number"}},
       "spare": {"type": "boolean", "description": "must not be cut"},
       "bleeds": {"type": "number", "description": "where it is opened: 0 not, 1 as a vessel; a picture only"},
       "label": {"type": "integer", "description": "value in the file it came from"}
      }
     }
    },
    "has_intensity": {"type": "boolean"},
    "format": {"type": "string", "description": "of the file; formula for a phantom"},
    "recipe": {
     "type": "object",
     "description": "how the bone was made; lengths in mm, levels in HU or the file's unit; no paths",
     "properties": {
      "source": {"type": "string", "description": "phantom:NAME, or empty: the user's file"},
      "series": {"type": "string", "description": "#2 as burr info lists them, or own: by its UID"},
      "spacing_mm": {"type": "array", "items": {"type": "number"}, "description": "instead of the file's"},
      "region": {"type": "array", "items": {"type": "integer"}, "description": "voxels of the file, first and last: i0, i1, j0, j1, k0, k1"},
      "allow_missing": {"type": "boolean", "description": "made though slices could not be read, or are not there"},
      "as_it_is": {"type": "boolean", "description": "made though the scan contradicts itself or is no CT"},
      "voxel_mm": {"type": "number", "description": "0: the finest axis"},
      "iso": {"type": "number", "description": "level of the surface"},
      "smooth": {"type": "number", "description": "noise removed; below 0: as measured"},
      "labels": {"type": "string", "description": "own: a table of the user's"},
      "materials": {"type": "string", "description": "own: a table of the user's"},
      "memory_mb": {"type": "number"},
      "keep": {"type": "object", "description": "which separate parts of the bone were kept; absent: all", "properties": {"largest": {"type": "integer", "description": "so many of the largest"}, "at_mm": {"type": "array", "items": {"type": "array", "items": {"type": "number"}}, "description": "and the parts at these points, LPS"}}},
      "drop_islands_mm3": {"type": "number", "description": "smaller parts were removed; absent: none"},
      "read_seconds": {"type": "number"},
      "read_memory_mb": {"type": "number"},
      "reserve_bricks": {"type": "integer", "description": "room for deposits"},
      "bone_law": {"type": "integer", "description": "by which law bone was made of a scan; absent: 1"},
      "margin": {"type": "boolean", "description": "layers of air where the scan's border cuts bone; absent: false"},
      "check_values": {"type": "boolean", "description": "the header's word on the values is checked, and the level of a scan without HU is estimated; absent: false"},
      "check_scan": {"type": "boolean", "description": "what should be there was compared with what is there, and inverted values were turned; absent: false"}
     }
    }
   }
  },
  "identity": {
   "type": "object",
   "description": "which session this is; no names",
   "properties": {
    "mode": {"enum": ["free", "learn", "practise", "exam"], "description": "what the session was for"},
    "learner": {"type": "string", "description": "a pseudonym; absent: nobody said who"},
    "attempt": {"type": "integer", "description": "of this learner at this case, from 1; 0: not counted"},
    "case_hash": {"type": "string", "description": "hexadecimal, the text_hash of the case; 0: no case"},
    "rubric_hash": {"type": "string", "description": "hexadecimal, of the rubric that was shown; 0: none"},
    "labels_hash": {"type": "string", "description": "hexadecimal, of the tissue of every voxel and the tissues' names"},
    "accepted_labels": {"type": "array", "items": {"type": "string"}, "description": "structures whose labels the user accepted in spite of their faults; absent: none"}
   }
  },
  "seal": {
   "type": "object",
   "description": "the seal of the start, of a station that a centre enrolled; that of the end is the metadata burr.seal; absent: nobody sealed it",
   "properties": {
    "station": {"type": "string", "description": "its name"},
    "nonce": {"type": "string", "description": "hexadecimal, 128 bit; the centre's store gave it for this session"},
    "given_ms": {"type": "integer", "description": "when, by the store's clock [ms since 1970, UTC]"},
    "signature": {"type": "string", "description": "hexadecimal, Ed25519"}
   }
  },
  "continued": {
   "type": "object",
   "description": "only in a second, third ... message: the session was left and continued; this part has the settings above, and its bone is the one at the end of the part before",
   "properties": {
    "first_tick": {"type": "integer", "description": "of this part"},
    "goes_on_with": {"type": "string", "description": "SHA-1 of the file as it was before; empty: nobody asked"}
   }
  },
  "shaft": {
   "type": "object",
   "description": "of the tool, behind the head",
   "properties": {"radius_m": {"type": "number"}, "length_m": {"type": "number"}}
  },
  "second": {
   "type": "object",
   "description": "the other hand; absent: there was none. Its rows are in /second, where tool_number 0 is its tool and the ledger is its own share",
   "properties": {
    "numbers": {"type": "object", "description": "settings; units are in the names", "additionalProperties": {"type": "number"}},
    "device": {"type": "string"},
    "tools": {"type": "array", "description": "one tool, as in tools; empty: a ball that never cuts"}
   }
  },
  "tools": {
   "type": "array",
   "description": "tools other than the round burr that the session could take; lengths in m",
   "items": {"type": "object", "properties": {
    "name": {"type": "string"},
    "parts": {"type": "array", "items": {"type": "object", "properties": {
     "shape": {"enum": ["ball", "capsule", "cylinder", "frustum", "vesica", "box", "wedge", "half_shell", "tube", "grid"]},
     "sizes_m": {"type": "array", "items": {"type": "number"}, "description": "a, b, c and the rounding"},
     "grid": {"type": "object", "description": "only of a grid, whose a is the edge of a cell; docs/understand/touch_tools.md", "properties": {
      "size": {"type": "array", "items": {"type": "integer"}, "description": "nodes along x, y, z"},
      "phi": {"type": "array", "items": {"type": "integer"}, "description": "distances in cells / 256, below 0 inside; x changes fastest"}}},
     "at_m": {"type": "array", "items": {"type": "number"}},
     "turn_xyzw": {"type": "array", "items": {"type": "number"}, "description": "tool_from_part"},
     "role": {"enum": ["cuts", "rubs", "seen"]}}}},
    "cutter": {"type": "object", "description": "how it moves; units are in the names"}}}
  },
  "case": {
   "type": "object",
   "description": "the case of the session",
   "properties": {
    "name": {"type": "string"},
    "text": {"type": "string", "description": "TOML; the path of a volume replaced by: own file"},
    "text_hash": {"type": "string", "description": "FNV-1a, 64 bits, of text"},
    "targets": {"type": "array", "items": {"type": "object", "properties": {"tissue": {"type": "string"}, "goal": {"enum": ["open", "expose", "remove"]}, "share": {"type": "number"}}}},
    "spare": {"type": "array", "items": {"type": "string"}}
   }
  }
 }
})";

}  // namespace

std::string session_schema() { return kSessionSchema; }

}  // namespace burr::record
