"""burr: touching and cutting bone, from Python. docs/use/python.md is the guide.

    import burr
    scene = burr.Scene("temporal-bone")
    with scene.session() as session:
        session.hand(scene.at_m - 5e-3 * scene.into)
        session.step(20)

Units are SI in arrays; names of other units end in them: _mm, _rpm. World frame: LPS [m].
"""
from burr._burr import (BUILD, ROWS_VERSION, Bone, Cancelled, Distance, Error, Event, Experiment, Hand, LawInput, Mesh, Recording, Scene, Session,
                        Snapshot, Tissue, Trial, __version__, cases, motions, phantoms, row_type, rubrics, table_text, tool_names)

__all__ = ["BUILD", "ROWS_VERSION", "Bone", "Cancelled", "Distance", "Error", "Event", "Experiment", "Hand", "LawInput", "Mesh",
           "Recording", "Scene", "Session", "Snapshot", "Tissue", "Trial", "__version__", "cases", "motions", "phantoms", "row_type", "rubrics",
           "table_text", "tool_names"]

# what the program does for a recording
from burr import program as _program  # noqa: E402

Recording.picture = _program.picture
del _program
