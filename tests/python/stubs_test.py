"""The stubs (python/burr/__init__.pyi) have the names and the parameters that the module has."""
import ast
import inspect
import os
import pathlib
import re
import unittest

import burr

STUBS = pathlib.Path(os.environ["BURR_CHECKOUT"]) / "python" / "burr" / "__init__.pyi"
# of Python itself
BORN = set(dir(object)) | {"__module__", "__doc__", "__dict__", "__weakref__", "__annotations__"}


def parameters(function):
    """[(name, only by name)] of a function in the stubs, without self."""
    given = function.args
    names = [(one.arg, False) for one in given.posonlyargs + given.args] + [(one.arg, True) for one in given.kwonlyargs]
    return [one for one in names if one[0] != "self"]


def told(function):
    """The same of a function in the module, as pybind11 prints it, or of Python."""
    if inspect.isfunction(function):
        return [(one.name, one.kind == one.KEYWORD_ONLY) for one in inspect.signature(function).parameters.values() if one.name != "self"]
    line = function.__doc__.splitlines()[0]
    inside = line[line.index("(") + 1:line.rindex(") ->")]
    names, named = [], False
    depth, part = 0, ""
    for letter in inside + ",":
        depth += (letter in "([{<") - (letter in ")]}>")
        if letter != "," or depth:
            part += letter
            continue
        name, part = part.split(":")[0].split("=")[0].strip(), ""
        if name == "*":
            named = True
        elif name and name != "self":
            names.append((name, named))
    return names


def public(names):
    return {name for name in names if not name.startswith("_") or re.fullmatch(r"__\w+__", name)}


class Stubs(unittest.TestCase):
    def setUp(self):
        self.tree = ast.parse(STUBS.read_text())
        self.classes = {one.name: one for one in self.tree.body if isinstance(one, ast.ClassDef)}
        self.functions = {one.name: one for one in self.tree.body if isinstance(one, ast.FunctionDef)}

    def test_names_of_the_module(self):
        annotated = {one.target.id for one in self.tree.body if isinstance(one, ast.AnnAssign)}
        only_stubs = {name for name, one in self.classes.items() if any(getattr(base, "id", "") == "TypedDict" for base in one.bases)}
        stubs = set(self.classes) | set(self.functions) | annotated
        self.assertEqual(stubs - only_stubs, set(burr.__all__))
        for name in burr.__all__:
            self.assertTrue(hasattr(burr, name), name)

    def test_members_of_classes(self):
        for name, stub in self.classes.items():
            real = getattr(burr, name, None)
            if real is None or issubclass(real, Exception):
                continue
            members = set()
            for one in stub.body:
                if isinstance(one, ast.FunctionDef):
                    members.add(one.name)
                elif isinstance(one, ast.AnnAssign):
                    members.add(one.target.id)
            there = public(vars(real)) - BORN - {"__repr__"}
            self.assertEqual(members - {"__init__"}, there - {"__init__"}, name)

    def test_parameters(self):
        for name, stub in self.functions.items():
            self.assertEqual(parameters(stub), told(getattr(burr, name)), name)
        checked = 0
        for name, stub in self.classes.items():
            real = getattr(burr, name, None)
            if real is None or issubclass(real, Exception):
                continue
            for one in stub.body:
                if not isinstance(one, ast.FunctionDef) or one.name in ("__enter__", "__exit__", "__len__"):
                    continue
                there = inspect.getattr_static(real, one.name)
                if isinstance(there, property):
                    continue
                self.assertEqual(parameters(one), told(getattr(real, one.name)), f"{name}.{one.name}")
                checked += 1
        self.assertGreater(checked, 40)


if __name__ == "__main__":
    unittest.main()
