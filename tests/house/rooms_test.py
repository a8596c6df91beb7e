#!/usr/bin/env python3
"""scripts/rooms.py must report nothing for a valid tree, and an error for each kind of invalid one."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "rooms.py"

GOOD = {
    "math/vec3.h": "#include <Eigen/Core>\n",
    "rt/ring.h": '#include "burr/base/check.h"\n',
    "base/check.h": "#include <vector>\n",
    "volume/bone.h": '#include "burr/rt/ring.h"\n#include "burr/math/vec3.h"\n',
    "device/hand_state.h": "",
    "haptics/proxy.cpp": '#include "burr/volume/bone.h"\n#include "burr/device/hand_state.h"\n',
    "render/gl/draw.cpp": "#include <epoxy/gl.h>\n#include <SDL.h>\n",
    "render/gl/worn.cpp": "#include <openxr/openxr.h>\n",
    "sound/speaker.cpp": '#include <SDL2/SDL.h>\n#include "burr/rt/ring.h"\n',
    "io/dicom.cpp": "#include <itkImage.h>\n",
}


def run(files):
    """files: {path inside src/burr, or beginning with apps/: text}"""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            file = pathlib.Path(folder) / name if name.startswith("apps/") else pathlib.Path(folder) / "src" / "burr" / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class Rooms(unittest.TestCase):
    def bad(self, name, text, sentence):
        code, said = run({**GOOD, name: text})
        self.assertEqual(code, 1, said)
        self.assertIn(sentence, said)

    def test_a_good_tree_passes(self):
        code, said = run(GOOD)
        self.assertEqual(code, 0, said)
        self.assertIn("haptics   -> device (1), volume (1)", said)
        self.assertIn("circles: none", said)

    def test_an_arrow_up_fails(self):
        self.bad("volume/cut.cpp", '#include "burr/edit/carve.h"\n', "the arrow volume -> edit is not listed")

    def test_an_arrow_sideways_fails(self):
        self.bad("surface/m.cpp", '#include "burr/haptics/proxy.h"\n', "the arrow surface -> haptics is not listed")

    def test_the_lowest_floor_knows_nobody(self):
        self.bad("base/word.h", '#include "burr/math/vec3.h"\n', "the arrow base -> math is not listed")
        self.bad("rt/word.h", '#include "burr/math/vec3.h"\n', "the arrow rt -> math is not listed")

    def test_a_list_of_public_headers_lies_in_no_room(self):
        code, said = run({**GOOD, "core.h": '#include "burr/volume/bone.h"\n'})
        self.assertEqual(code, 0, said)
        self.bad("core.h", '#include "burr/io/scan.h"\n', "includes burr/io/scan.h; it is a list of headers of base, math")
        self.bad("other.h", "", "lies in no room")

    def test_a_circle_fails(self):
        code, said = run({**GOOD, "volume/a.h": '#include "burr/edit/b.h"\n', "edit/b.h": '#include "burr/volume/a.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("circles: edit, volume", said)

    def test_two_files_in_a_circle_fail(self):
        code, said = run({**GOOD, "volume/a.h": '#include "burr/volume/b.h"\n', "volume/b.h": '#include "burr/volume/a.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("circle of files: src/burr/volume/a, src/burr/volume/b\n", said)
        self.assertNotIn("circles: none", said)

    def test_a_circle_through_the_sources_of_two_headers_fails(self):
        code, said = run({**GOOD, "volume/a.h": "", "volume/b.h": "", "volume/c.h": '#include "burr/volume/a.h"\n',
                          "volume/a.cpp": '#include "burr/volume/a.h"\n#include "burr/volume/b.h"\n',
                          "volume/b.cpp": '#include "burr/volume/b.h"\n#include "burr/volume/c.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("circle of files: src/burr/volume/a, src/burr/volume/b, src/burr/volume/c\n", said)

    def test_files_of_the_programs_are_looked_at_however_they_include(self):
        page = '#include "page.h"\n#include "verify/verify_report.h"\n'
        code, said = run({**GOOD, "apps/burr/verify/page.h": "", "apps/burr/verify/page.cpp": page,
                          "apps/burr/verify/verify_report.h": "", "apps/burr/verify/verify_report.cpp": '#include "page.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("circle of files: apps/burr/verify/page, apps/burr/verify/verify_report\n", said)

    def test_an_include_of_a_higher_floor_fails(self):
        app = {**GOOD, "apps/burr/shared/work.h": "", "apps/burr/window/ui/desk.h": '#include "shared/work.h"\n'}
        code, said = run(app)
        self.assertEqual(code, 0, said)
        self.assertIn("apps/burr/window/ui -> shared (1)", said)
        code, said = run({**app, "apps/burr/shared/work.cpp": '#include "window/ui/desk.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("apps/burr/shared/work.cpp: includes window/ui/desk.h; window/ui is on a higher floor", said)
        self.assertIn("circles: shared, window/ui", said)

    def test_pages_do_not_know_each_other(self):
        for name in ("window/mill/mill.h", "../mill/mill.h"):
            code, said = run({**GOOD, "apps/burr/window/mill/mill.h": "", "apps/burr/window/rate/rate.cpp": f'#include "{name}"\n'})
            self.assertEqual(code, 1)
            self.assertIn(f"includes {name}; window/mill is on the same floor", said)

    def test_a_folder_on_no_floor_fails(self):
        code, said = run({**GOOD, "apps/burr/cellar/wine.h": ""})
        self.assertEqual(code, 1)
        self.assertIn("folder 'cellar' is on no floor", said)

    def test_two_circles_are_two_lines(self):
        both = {f"{room}/{one}.h": f'#include "burr/{room}/{other}.h"\n' for room in ("volume", "io") for one, other in ("ab", "ba")}
        code, said = run({**GOOD, **both})
        self.assertEqual(code, 1)
        self.assertEqual(said.count("circle of files: "), 2, said)

    def test_a_header_its_source_and_a_line_of_files_are_no_circle(self):
        code, said = run({**GOOD, "volume/a.h": '#include "burr/volume/b.h"\n', "volume/a.cpp": '#include "burr/volume/a.h"\n',
                          "volume/b.h": "", "volume/b.cpp": '#include "burr/volume/b.h"\n#include "burr/volume/bone.h"\n',
                          "apps/burr/main.cpp": '#include "burr/volume/a.h"\n#include "burr/volume/b.h"\n'})
        self.assertEqual(code, 0, said)
        self.assertIn("circles: none", said)

    def test_an_unlisted_room_fails(self):
        self.bad("cellar/wine.h", "", "room 'cellar' is not listed")
        self.bad("volume/a.h", '#include "burr/cellar/wine.h"\n', "room 'cellar' is not listed")

    def test_a_file_in_no_room_fails(self):
        self.bad("everything.h", "", "lies in no room")

    def test_haptics_knows_only_the_hand_of_a_device(self):
        self.bad("haptics/a.cpp", '#include "burr/device/device.h"\n', "of device, haptics may know only hand_state.h")

    def test_graphics_stay_in_their_corner(self):
        self.bad("render/scene.cpp", "#include <epoxy/gl.h>\n", "graphics belongs into render/gl")
        self.bad("sound/screen.cpp", "#include <epoxy/gl.h>\n", "graphics belongs into render/gl")
        self.bad("sound/screen.cpp", "#include <SDL2/SDL_opengl.h>\n", "graphics belongs into render/gl")
        self.bad("device/worn.cpp", "#include <openxr/openxr.h>\n", "a headset belongs into render/gl")
        self.bad("sim/window.cpp", "#include <SDL2/SDL.h>\n", "graphics and sound belongs into render/gl or sound")

    def test_sound_knows_no_session(self):
        self.bad("sound/a.cpp", '#include "burr/haptics/vibration.h"\n', "the arrow sound -> haptics is not listed")
        self.bad("sound/a.h", "#include <SDL2/SDL.h>\n", "a header shows others only")

    def test_formats_stay_at_the_border(self):
        self.bad("volume/load.cpp", "#include <itkImage.h>\n", "belongs into io")
        self.bad("surface/save.cpp", "#include <assimp/scene.h>\n", "belongs into io")

    def test_http_stays_in_its_room(self):
        self.bad("device/haply/line.cpp", "#include <boost/beast/core.hpp>\n", "HTTP and WebSocket belongs into net")
        self.bad("device/link.cpp", '#include "burr/net/client.h"\n', "of net, device may know only web_socket.h")

    def test_a_vendor_stays_in_its_own_folder(self):
        self.bad("sim/a.cpp", "#include <HD/hd.h>\n", "a folder of its own under device/")
        self.bad("device/a.cpp", "#include <HD/hd.h>\n", "a folder of its own under device/")
        self.bad("device/falcon/a.cpp", '#include "burr/device/touch/b.h"\n', "known only to itself")

    def test_headers_show_no_third_party(self):
        self.bad("io/dicom.h", "#include <itkImage.h>\n", "a header shows others only")
        self.bad("record/json.h", "#include <nlohmann/json.hpp>\n", "a header shows others only")

    def test_a_private_header_may_show_more_but_only_to_its_room(self):
        private = {**GOOD, "volume/json.h": "// volume/json.h - words; for .cpp files of\n// this room only.\n#include <nlohmann/json.hpp>\n"}
        code, said = run({**private, "volume/a.cpp": '#include "burr/volume/json.h"\n'})
        self.assertEqual(code, 0, said)
        code, said = run({**private, "edit/a.cpp": '#include "burr/volume/json.h"\n'})
        self.assertEqual(code, 1)
        self.assertIn("is for room volume only", said)

    def test_the_library_does_not_reach_out(self):
        self.bad("volume/a.cpp", '#include "scenes/ball.h"\n', "say it from the root")


if __name__ == "__main__":
    unittest.main()
