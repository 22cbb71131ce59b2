"""Makes tf2_msgs for an environment of ROS 2 wheels, which lack it, with the generators of ROS 2 that
they have.

    make_tf2_msgs.py ENVIRONMENT FOLDER      run by the Python of the environment

Afterwards FOLDER/tf2_msgs is a Python package, with its libraries in FOLDER/lib. Needs gcc, g++ and
the headers of Python.
"""

import importlib.metadata
import os
import pathlib
import subprocess
import sys
import sysconfig

ENVIRONMENT, OUT = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
os.environ["AMENT_PREFIX_PATH"] = str(ENVIRONMENT)
SHARE, LIB = ENVIRONMENT / "share", OUT / "lib"

import numpy  # noqa: E402
import rosidl_cli.entry_points as entry_points  # noqa: E402
from rosidl_generator_c.cli import GenerateC  # noqa: E402
from rosidl_generator_py.cli import GeneratePython  # noqa: E402
from rosidl_typesupport_c.cli import GenerateCTypesupport  # noqa: E402
from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport  # noqa: E402
from rosidl_typesupport_introspection_c.cli import GenerateIntrospectionCTypesupport  # noqa: E402


def once(group_name, **_):
    """Entry points of a group; the wheels list each twice, which the original refuses."""
    return {one.name: one for one in importlib.metadata.entry_points(group=group_name)}


entry_points.get_entry_points = once


def generate():
    folder = OUT / "tf2_msgs"
    definition = folder / "msg" / "TFMessage.msg"
    definition.parent.mkdir(parents=True)
    definition.write_text("geometry_msgs/TransformStamped[] transforms\n")
    os.chdir(folder)
    include = [str(SHARE / name) for name in ("geometry_msgs", "std_msgs", "builtin_interfaces")]
    parts = {GenerateC: [], GenerateIntrospectionCTypesupport: [], GenerateFastRTPSCTypesupport: [],
             GenerateCTypesupport: ["rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c"],
             GeneratePython: ["rosidl_typesupport_c"]}
    for kind, supports in parts.items():
        generator = kind.__new__(kind)  # its own set-up looks for what only an installed ROS has
        setattr(generator, f"_{kind.__name__}__typesupport_implementations", supports)
        generator.generate("tf2_msgs", ["msg/TFMessage.msg"], include, folder)
    (folder / "__init__.py").touch()


def build():
    LIB.mkdir()
    headers = [OUT, ENVIRONMENT / "include", *(ENVIRONMENT / "include").iterdir(),
               sysconfig.get_path("include"), numpy.get_include()]
    options = ["-O1", "-shared", "-fPIC", "-w", *(f"-I{header}" for header in headers),
               *(f"{flag}{folder}" for folder in (ENVIRONMENT / "lib", LIB)
                 for flag in ("-L", "-Wl,-rpath,")), "-Wl,--allow-shlib-undefined"]
    package, detail = OUT / "tf2_msgs", OUT / "tf2_msgs" / "msg" / "detail"

    def link(compiler, out, sources, *libraries):
        subprocess.run([compiler, *options, *sources, "-o", out, *(f"-l{name}" for name in libraries)],
                       check=True)

    own = "tf2_msgs__rosidl_"
    link("gcc", LIB / f"lib{own}generator_c.so",
         [detail / "tf_message__functions.c", detail / "tf_message__description.c"],
         "geometry_msgs__rosidl_generator_c", "rosidl_runtime_c", "rcutils")
    link("g++", LIB / f"lib{own}typesupport_fastrtps_c.so", [detail / "tf_message__type_support_c.cpp"],
         own + "generator_c", "geometry_msgs__rosidl_typesupport_fastrtps_c")
    link("gcc", LIB / f"lib{own}typesupport_introspection_c.so", [detail / "tf_message__type_support.c"],
         own + "generator_c", "geometry_msgs__rosidl_typesupport_introspection_c")
    link("g++", LIB / f"lib{own}typesupport_c.so", [package / "msg" / "tf_message__type_support.cpp"],
         own + "generator_c", "rosidl_typesupport_c")
    link("gcc", package / "tf2_msgs_s__rosidl_typesupport_c.so",
         [package / "_tf2_msgs_s.ep.rosidl_typesupport_c.c", package / "msg" / "_tf_message_s.c"],
         own + "typesupport_c", own + "generator_c", "geometry_msgs__rosidl_generator_py")


generate()
build()
