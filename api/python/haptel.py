"""Haptel from Python, over its C interface (haptel/c.h): textures as arrays of heights and gradients, and scenes.

    import haptel
    ripple = haptel.Texture("texture ripple() { return 50um * sinturn(p.x / 4mm); }")
    heights, gradients = ripple.evaluate([(0.001 * i, 0, 0) for i in range(100)])

Points are triples in metres: a list of them, or any array of doubles of shape (n, 3), which then also come back
(numpy's, if it is there). What is refused raises haptel.Error with the message that the command line gives.
read_trace() reads what `haptel explore --out` has written.
"""

import array
import ctypes
import os
import re
import time

_double, _size, _text = ctypes.c_double, ctypes.c_size_t, ctypes.c_char_p


class Error(Exception):
    pass


class _Value(ctypes.Structure):
    _fields_ = [("name", _text), ("value", _text)]


class Material(ctypes.Structure):
    _fields_ = [("stiffness_n_per_m", _double), ("damping_n_s_per_m", _double), ("static_friction", _double),
                ("dynamic_friction", _double)]

    def __init__(self, stiffness_n_per_m=800, damping_n_s_per_m=1, static_friction=0.3, dynamic_friction=0.2):
        super().__init__(stiffness_n_per_m, damping_n_s_per_m, static_friction, dynamic_friction)


class Settings(ctypes.Structure):
    _fields_ = [("rate_hz", _double), ("force_limit_n", _double), ("v_max_m_per_s", _double), ("force_rise_s", _double),
                ("force_model", ctypes.c_int32), ("probe", ctypes.c_int32), ("probe_length_m", _double),
                ("probe_radius_m", _double)]
    force_models = ("displaced", "paper", "paper_unit", "ho99", "lateral")
    probes = ("point", "sphere", "stylus", "gripper")

    def __init__(self, rate_hz=1000, force_limit_n=7, v_max_m_per_s=0.3, force_rise_s=0.1, force_model="displaced",
                 probe="point", probe_length_m=0.15, probe_radius_m=0):
        super().__init__(rate_hz, force_limit_n, v_max_m_per_s, force_rise_s, self.force_models.index(force_model),
                         self.probes.index(probe), probe_length_m, probe_radius_m)


class Force(ctypes.Structure):
    _fields_ = [("force_n", _double * 3), ("torque_n_m", _double * 3), ("grip_force_n", _double), ("depth_m", _double), ("height_m", _double),
                ("contacts", ctypes.c_uint32), ("faults", ctypes.c_uint32)]


class Report(ctypes.Structure):
    _fields_ = [("faulted", ctypes.c_int32), ("seconds", _double)] + [
        (name, ctypes.c_uint64) for name in ("ticks", "contact_ticks", "missed_deadlines", "faults",
                                             "textures_changed")] + [
        (name, _double) for name in ("force_rms_n", "force_max_n", "energy_j", "tick_ns_median", "tick_ns_p99")]


class Facts(ctypes.Structure):
    _fields_ = [(name, _double) for name in ("height_min_m", "height_max_m", "slope_max", "curvature_max_per_m")] + [
        ("continuity", ctypes.c_uint32), ("operations_max", ctypes.c_uint32)]


def _library(name):
    # HAPTEL_LIBRARIES: the folder of the two, where the system does not find them by itself.
    folder = os.environ.get("HAPTEL_LIBRARIES")
    return ctypes.CDLL(os.path.join(folder, name) if folder else name)


_runtime, _compiler = _library("libhaptel.so.@so_version@"), _library("libhaptel_compiler.so.@so_version@")


def _declare(library, result, name, *arguments):
    function = getattr(library, "haptel_" + name)
    function.restype, function.argtypes = result, arguments
    return function


_handle, _number, _of_doubles = ctypes.c_void_p, ctypes.c_uint32, ctypes.POINTER(_double)
_values = (ctypes.POINTER(_Value), _size)
_compile = _declare(_compiler, _handle, "compile", _text, _text, *_values)
_compiled_ok = _declare(_compiler, ctypes.c_int32, "compiled_ok", _handle)
_compiled_messages = _declare(_compiler, _text, "compiled_messages", _handle)
_compiled_facts = _declare(_compiler, Facts, "compiled_facts", _handle)
_compiled_free = _declare(_compiler, None, "compiled_free", _handle)
_evaluate = _declare(_compiler, ctypes.c_int32, "evaluate", _handle, ctypes.c_void_p, _size, ctypes.c_void_p,
                     ctypes.c_void_p)
_compiler_new = _declare(_compiler, _handle, "compiler", ctypes.c_int32)
_source_free = _declare(_runtime, None, "source_free", _handle)
_builder_new = _declare(_runtime, _handle, "builder_new", _handle)
_builder_free = _declare(_runtime, None, "builder_free", _handle)
_of_material = ctypes.POINTER(Material)
_add_shape = _declare(_runtime, _number, "add_shape", _handle, _text, _double, _of_material)
_add_file = _declare(_runtime, _number, "add_file", _handle, _text, _double, _of_material)
_add_mesh = _declare(_runtime, _number, "add_mesh", _handle, ctypes.c_void_p, _size, ctypes.c_void_p, _size,
                     _of_material)
_object_texture = _declare(_runtime, ctypes.c_int32, "object_texture", _handle, _number, _text, *_values)
_object_place = _declare(_runtime, ctypes.c_int32, "object_place", _handle, _number, _double * 3, _double * 3)
_build = _declare(_runtime, _handle, "build", _handle, ctypes.POINTER(Settings))
_load_scene = _declare(_runtime, _handle, "load_scene", _text, _handle)
_scene_ok = _declare(_runtime, ctypes.c_int32, "scene_ok", _handle)
_scene_messages = _declare(_runtime, _text, "scene_messages", _handle)
_scene_set = _declare(_runtime, _text, "scene_set", _handle, _number, _text, _text)
_scene_free = _declare(_runtime, None, "scene_free", _handle)
_servo_new = _declare(_runtime, _handle, "servo_new", _handle, _text, _double, ctypes.c_int32)
_servo_ok = _declare(_runtime, ctypes.c_int32, "servo_ok", _handle)
_servo_messages = _declare(_runtime, _text, "servo_messages", _handle)
_servo_start = _declare(_runtime, None, "servo_start", _handle)
_servo_request_stop = _declare(_runtime, None, "servo_request_stop", _handle)
_servo_running = _declare(_runtime, ctypes.c_int32, "servo_running", _handle)
_servo_stop_reason = _declare(_runtime, _text, "servo_stop_reason", _handle)
_servo_wait = _declare(_runtime, Report, "servo_wait", _handle)
_servo_free = _declare(_runtime, None, "servo_free", _handle)
_renderer_new = _declare(_runtime, _handle, "renderer_new", _handle)
_renderer_messages = _declare(_runtime, _text, "renderer_messages", _handle)
_tick = _declare(_runtime, Force, "tick", _handle, _double * 3, _double * 3, ctypes.c_uint64)
_between_ticks = _declare(_runtime, None, "between_ticks", _handle)
_renderer_free = _declare(_runtime, None, "renderer_free", _handle)
version = _declare(_runtime, _text, "version")().decode()


def _bytes(text):
    return os.fspath(text).encode()


def _named(values):
    pairs = [(name.encode(), str(value).encode()) for name, value in (values or {}).items()]
    return (_Value * len(pairs))(*pairs), len(pairs)


def _three(values):
    return (_double * 3)(*values)


def _in_threes(rows, code, what):
    if any(len(row) != 3 for row in rows):
        raise Error("expected " + what + " of three numbers each")
    return array.array(code, (number for row in rows for number in row))


class _Owner:
    _handle = None
    _free = None

    def __del__(self):
        if self._handle:
            type(self)._free(self._handle)


class Texture(_Owner):
    """One texture of a text, with values: Texture(text, "ripple", depth="80um"). `**{"size.x": 1}` sets a component."""

    _free = _compiled_free

    def __init__(self, text, name="", /, **values):
        self._handle = _compile(text.encode(), name.encode(), *_named(values))
        if not _compiled_ok(self._handle):
            raise Error(_compiled_messages(self._handle).decode())

    @property
    def facts(self):
        """What is proven over a box of 10 cm: heights in metres, slope, curvature in 1/m."""
        return _compiled_facts(self._handle)

    def evaluate(self, points):
        """Heights in metres, and gradients as triples, at points in metres."""
        if hasattr(points, "__array_interface__"):
            import numpy
            at = numpy.ascontiguousarray(points, dtype=float)
            if at.ndim != 2 or at.shape[1] != 3:
                raise Error("expected points of three numbers each")
            heights, gradients = numpy.empty(len(at)), numpy.empty((len(at), 3))
            _evaluate(self._handle, at.ctypes.data, len(at), heights.ctypes.data, gradients.ctypes.data)
            return heights, gradients
        at = _in_threes(points, "d", "points")
        count = len(points)
        heights, gradients = array.array("d", bytes(8 * count)), array.array("d", bytes(24 * count))
        _evaluate(self._handle, at.buffer_info()[0], count, heights.buffer_info()[0], gradients.buffer_info()[0])
        return list(heights), [tuple(gradients[3 * i:3 * i + 3]) for i in range(count)]


class Scene(_Owner):
    """What SceneBuilder.finish() and load_scene() give. `messages` holds warnings and notes."""

    _free = _scene_free

    def __init__(self, handle):
        self._handle = handle
        self.messages = _scene_messages(handle).decode()
        if not _scene_ok(handle):
            raise Error(self.messages)

    def set(self, number, /, **values):
        """Of the texture of the object of that number, from 1: felt from the next tick on."""
        for name, value in values.items():
            refused = _scene_set(self._handle, number, name.encode(), str(value).encode()).decode()
            if refused:
                raise Error(refused)

    def run(self, device="simulated:premium", seconds=1, virtual_time=None):
        """Feels it with a device for a while, 0: until Ctrl-C; returns a Report.

        A simulated hand lives in virtual time, unless it is not to: as fast as it can, and the same in every run.
        """
        if virtual_time is None:
            virtual_time = seconds > 0 and device.startswith(("simulated", "replay"))
        servo = _servo_new(self._handle, device.encode(), seconds, virtual_time)
        try:
            if not _servo_ok(servo):
                raise Error(_servo_messages(servo).decode())
            _servo_start(servo)
            while _servo_running(servo):
                time.sleep(0.001) # here an interrupt is seen, and ends the run
            report = _servo_wait(servo)
            if report.faulted:
                raise Error(_servo_stop_reason(servo).decode())
            return report
        finally:
            _servo_free(servo)


def load_scene(file, follow_files=False):
    textures = _compiler_new(follow_files)
    try:
        return Scene(_load_scene(_bytes(file), textures))
    finally:
        _source_free(textures)


class SceneBuilder(_Owner):
    """Adds objects, each known by its number, from 1."""

    _free = _builder_free

    def __init__(self, follow_files=False):
        textures = _compiler_new(follow_files)
        self._handle = _builder_new(textures)
        _source_free(textures)

    def add(self, shape, size_m, material=None, texture="", values=None, position_m=None, rotation_deg=None):
        """A shape ("plane", "box", "sphere", "icosphere", "torus"), or a mesh file, scaled to that size; 0: as it is."""
        own = ctypes.byref(material or Material())
        number = _add_shape(self._handle, _bytes(shape), size_m, own) or _add_file(self._handle, _bytes(shape), size_m,
                                                                                   own)
        return self._dress(number, texture, values, position_m, rotation_deg)

    def add_mesh(self, positions_m, triangles, material=None, texture="", values=None, position_m=None,
                 rotation_deg=None):
        """Positions as triples of metres, triangles as triples of their indices."""
        at, corners = _in_threes(positions_m, "d", "positions"), _in_threes(triangles, "I", "triangles")
        number = _add_mesh(self._handle, at.buffer_info()[0], len(at) // 3, corners.buffer_info()[0],
                           len(corners) // 3, ctypes.byref(material or Material()))
        return self._dress(number, texture, values, position_m, rotation_deg)

    def _dress(self, number, texture, values, position_m, rotation_deg):
        if texture:
            _object_texture(self._handle, number, _bytes(texture), *_named(values))
        nowhere = (0, 0, 0)
        _object_place(self._handle, number, _three(nowhere if position_m is None else position_m),
                      _three(nowhere if rotation_deg is None else rotation_deg))
        return number

    def finish(self, settings=None):
        return Scene(_build(self._handle, ctypes.byref(settings or Settings())))


class Renderer(_Owner):
    """A loop of one's own: the force for a pose, once per period of the scene's rate."""

    _free = _renderer_free

    def __init__(self, scene):
        self._handle = _renderer_new(scene._handle)
        if refused := _renderer_messages(self._handle).decode():
            raise Error(refused)

    def tick(self, tip_m, tail_m=(0, 0, 0), periods=1):
        force = _tick(self._handle, _three(tip_m), _three(tail_m), periods)
        _between_ticks(self._handle)
        return force


# Of the columns in runtime/servo/tick_columns.h: those that every trace has, and those that count or number something.
_trace_columns = ("tick time_s x_m y_m z_m tail_x_m tail_y_m tail_z_m fx_n fy_n fz_n contact depth_m height_m compute_ns "
                  "binding").split()
_whole_columns = frozenset("tick contact compute_ns binding interrupted waiting degraded object faults woken_ns "
                           "wake_late_ns".split())


def read_trace(file):
    """The columns of a trace.csv by their names, a number for each tick: read_trace("run/trace.csv")["fz_n"].

    Arrays of numpy's, if it is there, and else lists. Ticks, nanoseconds and whatever else is counted are whole numbers.
    """
    path = os.fsdecode(file)
    if not os.path.isfile(path):
        raise Error(f"{path}: the trace " + ("is a folder" if os.path.isdir(path) else
                                             "is not a regular file" if os.path.exists(path) else "does not exist"))
    try:
        with open(path, encoding="utf-8", errors="replace") as lines:
            return _columns_of(lines, path)
    except OSError as error:
        raise Error(f"{path}: the trace cannot be read: {error.strerror}") from error


def _columns_of(lines, path):
    first = lines.readline().rstrip("\n")
    if first.startswith("HAPTRACE"):
        raise Error(f"{path} is a recording: `haptel replay FILE --csv trace.csv` makes a trace of it")
    if not first:
        raise Error(f"{path}:1: expected a trace (a CSV file as `haptel explore --out` writes it), but there is no header")
    names = first.split(",")
    for name in _trace_columns:
        if name not in names:
            raise Error(f"{path}:1: the trace has no column `{name}`")
    columns = [array.array("q" if name in _whole_columns else "d") for name in names]
    kinds = [int if name in _whole_columns else float for name in names]
    numbers = re.compile("[-+.,0-9Ee]*") # Python itself takes `nan`, ` 1` and `1_0`, too
    for at, line in enumerate(lines, 2):
        line = line.rstrip("\n")
        if not line:
            continue
        cells = line.split(",")
        if len(cells) != len(names):
            raise Error(f"{path}:{at}: expected {len(names)} values, found {len(cells)}")
        is_plain = numbers.fullmatch(line)
        for name, column, kind, cell in zip(names, columns, kinds, cells):
            try:
                if not is_plain and not numbers.fullmatch(cell):
                    raise ValueError
                column.append(kind(cell))
            except (ValueError, OverflowError):
                what = "a whole number" if kind is int else "a number"
                raise Error(f"{path}:{at}: expected {what} in column `{name}`, found `{cell}`") from None
    try:
        import numpy
    except ImportError:
        return dict(zip(names, map(list, columns)))
    return dict(zip(names, map(numpy.array, columns)))
