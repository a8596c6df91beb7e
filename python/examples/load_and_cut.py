#!/usr/bin/env python3
"""Opens a bone, mills a groove into it by hand, and writes what was removed.

    load_and_cut.py [BONE] [OUT]        a file, a DICOM folder or phantom:NAME; a folder for the results
"""
import pathlib
import sys

import numpy as np

import burr


def main(source="phantom:block", out="."):
    scene = burr.Scene(source, burr_mm=4)
    print(scene.bone)
    aside = np.cross(scene.into, (0, 1.0, 0))
    aside /= np.linalg.norm(aside)
    lean = (np.cos(0.5), np.sin(0.5), 0, 0)  # w, x, y, z: a burr cuts with its side
    with scene.session() as session:
        session.hand(scene.at_m - 6e-3 * scene.into, lean, pedal=1, ticks=0)
        session.step(600)  # forces begin slowly
        for n in range(20):
            deep = -1.5e-3 + 1e-4 * n  # of the burr's middle, below the surface [m]
            session.hand(scene.at_m + deep * scene.into + 4e-3 * (-1) ** n * aside, ticks=200)
            session.step(200)
        rows = session.rows()
        after = session.bone()
    force = np.linalg.norm(rows["force_n"], axis=1)
    print(f"{len(rows)} ticks, {1e9 * rows['removed_m3'][-1]:.2f} mm3 removed, at most {force.max():.2f} N")
    folder = pathlib.Path(out)
    after.export(str(folder / "after.stl"))
    after.export(str(folder / "removed.stl"), part="removed", before=scene.bone)
    np.save(folder / "ticks.npy", rows)
    return rows


if __name__ == "__main__":
    main(*sys.argv[1:])
