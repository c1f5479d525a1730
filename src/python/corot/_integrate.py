"""Integration in time (corot/integrate.h), and frames that follow the body between steps."""
from __future__ import annotations

import struct
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _convert as cv
from ._errors import FormatError, InvalidError
from ._handle import Handle
from ._library import Pending, ffi, has, lib, need
from ._model import _list_kinds
from ._state import State

_EPSILON = sys.float_info.epsilon
_SAVED = struct.Struct("<8sd")  # before what C saves: our mark, and the time of the last kink
_MARK = b"corot-py"


class Integrator(Handle):
    """Starts at (t, u, v) and advances by steps. u and v [n] are copied; None is zero.

    Settings are keywords named as in corot_integrator_def: method ("cvode", "ida", "arkode", "erk",
    "backward-euler", ...), rtol, atol_displacement, atol_velocity, max_order, order, table, max_steps,
    first_step, min_step, max_step, tangent, step (of a method of constant step [s]), ...; `linear` is
    the name of a solver, or a mapping of the fields of corot_linear_def. What is not said is chosen.

    policy: when held or extrapolated frames are found anew, as a mapping of the fields of
    corot_frame_policy: {"frames": "held", "interval": 0.02}. Then `clock` carries it out.

    A state has one integrator at a time. InvalidError: a setting, or a start that is not finite;
    TypeError: no such setting.
    """

    clock: FrameClock | None

    def __init__(self, state: State, t: float = 0.0, u: ArrayLike | None = None,
                 v: ArrayLike | None = None, *, policy: Mapping[str, Any] | None = None,
                 **settings: Any) -> None:
        need("corot_integrator_create", "an integrator")
        if not isinstance(state, State):
            raise TypeError(f"state is a {type(state).__name__}, and a corot.State is wanted")
        definition, keep = ffi.new("corot_integrator_def *"), []
        lib.corot_integrator_set_defaults(definition, ffi.sizeof("corot_integrator_def"))
        cv.fill(definition, settings, keep, "Integrator")
        t = cv.real(t, "t")
        u = np.zeros(state._n) if u is None else state._field(u)
        v = np.zeros(state._n) if v is None else state._field(v, "v")
        out = ffi.new("corot_integrator **")
        with state._evaluate() as pointer:
            lib.corot_state_enter(pointer, t)
            state._check(lib.corot_integrator_create(definition, state._m, pointer, t, cv.doubles(u),
                                                     cv.doubles(v), out))
            self._open(out[0], lib.corot_integrator_destroy, state, guard=state._guard)
        self.state, self.model = state, state.model
        self._pending = Pending()
        self._t, self._kinked = t, t
        self._step = float(definition.step)
        self._now: tuple[np.ndarray, np.ndarray] | None = None
        self.clock = None
        if policy is not None:
            self.clock = FrameClock(self, u, v, **policy)

    def __repr__(self) -> str:
        if self.closed:
            return "<Integrator, closed>"
        return f"<Integrator {self.chosen.method} at t = {self._t:g} s>"

    @contextmanager
    def _evaluate(self) -> Iterator[Any]:
        with self.state._evaluate():
            yield self._pointer

    def _check(self, status: int) -> None:
        self._pending.raise_kept()
        self.state._check(status)

    # Steps

    def step(self, t_stop: float) -> cv.Record:
        """One step: t reached [s], its length h [s], order, error (1 is the tolerance), newton. Under
        error control never beyond t_stop; a method of constant step keeps to its own grid. Where loads
        have kinks (Model.kinks), stop there, and call `kink()`: `advance` does so by itself.

        IntegrationError: it gave up; what was reached remains readable. InvalidError: t_stop is not
        after the time reached."""
        t_stop, out = cv.real(t_stop, "t_stop"), ffi.new("corot_step *")
        with self._evaluate() as pointer:
            self._advance(pointer, t_stop, out)
        return cv.record(out)

    def _advance(self, pointer: Any, t_stop: float, out: Any) -> None:
        self._now = None
        self._check(lib.corot_integrator_step(pointer, t_stop, out))
        self._t = float(out.t)

    @property
    def t(self) -> float:
        """Time reached [s]."""
        return self._t

    def at(self, t: float, out: tuple[np.ndarray, np.ndarray] | None = None
           ) -> tuple[np.ndarray, np.ndarray]:
        """u and v [n] at any t within the last step. InvalidError: t is not within it."""
        n = self.state._n
        given = (None, None) if out is None else out
        if not isinstance(given, (tuple, list)) or len(given) != 2:
            raise TypeError("out is to be two arrays, for u and for v")
        u, v = cv.output(given[0], (n,), "out[0]"), cv.output(given[1], (n,), "out[1]")
        cv.apart(u, v)
        t = cv.real(t, "t")
        with self._evaluate() as pointer:
            self._check(lib.corot_integrator_at(pointer, t, cv.doubles(u), cv.doubles(v)))
        return u, v

    def _reached(self) -> tuple[np.ndarray, np.ndarray]:
        if self._now is None or self.closed:
            u, v = self.at(self._t)
            u.flags.writeable = v.flags.writeable = False
            self._now = u, v
        return self._now

    @property
    def u(self) -> np.ndarray:
        """Displacements [n] [m] at `t`, for reading; a later step makes a new array."""
        return self._reached()[0]

    @property
    def v(self) -> np.ndarray:
        """Velocities [n] [m/s] at `t`, as u."""
        return self._reached()[1]

    def advance(self, times: ArrayLike, each: Callable[[cv.Record], Any] | None = None
                ) -> tuple[np.ndarray, np.ndarray]:
        """Steps to the last of `times` [k], ascending, and returns u and v there, [k, n] each.

        The steps are the method's own, as they are in `corot run`: they do not stop at `times`, but at
        the kinks of loads and motions, and where the policy of frames says. `each` is called after each
        step, with what `step` returns; it may read the integrator, change inputs and call `changed`.
        A single time gives [1, n]. Failures as of `step`; what was reached by then is at `t`."""
        times = np.atleast_1d(np.asarray(times))
        times = cv.reals(times, (None,), "times")
        if len(times) == 0 or not np.isfinite(times).all() or (np.diff(times) < 0).any():
            raise InvalidError("times are to be finite and ascending, one at least")
        end, n = float(times[-1]), self.state._n
        U, V = np.zeros((len(times), n)), np.zeros((len(times), n))
        near, done = 1e-12 * abs(end), 0
        kinks = self._list_kinks(end)
        out = ffi.new("corot_step *")
        while True:
            while done < len(times) and times[done] <= self._t + near:
                U[done], V[done] = self.at(min(times[done], self._t))
                done += 1
            if self._t >= end - near:
                return U, V
            stop = min(kinks[0] if kinks else np.inf, self.clock.stop if self.clock else np.inf)
            with self._evaluate() as pointer:
                if self._step > 0 and kinks and kinks[0] < self._t + self._step - near:
                    lib.corot_state_enter(self.state._pointer, np.nan)
                self._advance(pointer, stop if stop < end - near else end, out)
            while done < len(times) and times[done] <= self._t + near:
                U[done], V[done] = self.at(min(times[done], self._t))
                done += 1
            self._pass_kinks(kinks)
            if self.clock:
                self.clock.tick()
            if each is not None:
                each(cv.record(out))

    def _list_kinks(self, end: float) -> list[float]:
        """Those up to the end that are still to come, that at the time reached among them unless it was
        passed already."""
        found = self.model.kinks(self._kinked, np.nextafter(end, np.inf))
        ahead = [float(k) for k in found if k >= self._t - 4 * _EPSILON * abs(self._t)]
        if ahead and ahead[0] <= self._t:
            self._pass_kinks(ahead)
        return ahead

    def _pass_kinks(self, kinks: list[float]) -> None:
        passed = False
        while kinks and kinks[0] <= self._t + 4 * _EPSILON * abs(self._t):
            kink = kinks.pop(0)
            passed, self._kinked = True, kink
            with self._evaluate():
                lib.corot_state_enter(self.state._pointer, max(kink, self._t))
        if passed:
            self.kink()

    def kink(self) -> None:
        """Call this at a kink of a load or motion, at the end of the step that stops there, and after
        State.enter."""
        with self._evaluate() as pointer:
            self._kinked = max(self._kinked, self._t)
            self._check(lib.corot_integrator_kink(pointer))

    def changed(self, history: str = "auto") -> None:
        """Call this after a change of the state's inputs or its held frames, at the end of a step.
        history: what to do with the past of the solution: auto, keep, restart."""
        which = cv.choose("corot_history", history, "history")
        with self._evaluate() as pointer:
            self._check(lib.corot_integrator_changed(pointer, which))

    # What it knows

    def work(self, t: float | None = None) -> tuple[float, float]:
        """Dissipated and external work [J] from the start to t, within the last step; None: its end."""
        dissipated, external = ffi.new("double *"), ffi.new("double *")
        t = self._t if t is None else cv.real(t, "t")
        with self._evaluate() as pointer:
            self._check(lib.corot_integrator_work(pointer, t, dissipated, external))
        return float(dissipated[0]), float(external[0])

    def energies(self) -> cv.Record:
        """Energies and powers at the end of the last step (corot_energies)."""
        u, v = self._reached()
        out = ffi.new("corot_energies *")
        with self._evaluate() as pointer:
            self._check(lib.corot_integrator_energy(pointer, cv.doubles(u), cv.doubles(v), out))
        return cv.record(out)

    @property
    def statistics(self) -> cv.Record:
        """Counts of the whole run under SUNDIALS' names, and times by phase [s] (corot_statistics)."""
        with self._guard:
            return cv.record(lib.corot_integrator_statistics(self._pointer))

    @property
    def chosen(self) -> cv.Record:
        """What was chosen where the settings left it open (corot_integrator_choice)."""
        with self._guard:
            return cv.record(lib.corot_integrator_chosen(self._pointer))

    # Where the headers have it: all of its state as bytes, and back.

    if has("corot_integrator_save"):

        def save(self) -> bytes:
            """The state of the integration as bytes, from which `restore` goes on to the last bit, here
            or in another process: time, u and v, the frames and their clock, what the inputs say, work and
            statistics. Functions of yours are not among it. The integrator itself begins anew from
            these bytes, so save "cvode" and "ida" seldom: they begin at order 1 (corot/checkpoint.h).

            InvalidError: the inputs have changed, and `changed` was not called."""
            blob, size = ffi.new("void **"), ffi.new("size_t *")
            with self._evaluate() as pointer:
                self._check(lib.corot_integrator_save(pointer, blob, size))
            try:
                return _SAVED.pack(_MARK, self._kinked) + bytes(ffi.buffer(blob[0], size[0]))
            finally:
                lib.corot_blob_free(blob[0])

        def restore(self, saved: bytes) -> None:
            """Goes to where an integrator of the same settings, on an equal model, was saved; its state's
            inputs, and the frame clock that was made of it last, go along.

            FormatError: these are no bytes of `save`. InvalidError: they are damaged, or of another
            model, of other settings, or the saved one had inputs or a clock, and this one has none."""
            saved = bytes(saved)
            if len(saved) < _SAVED.size or _SAVED.unpack_from(saved)[0] != _MARK:
                raise FormatError(f"{len(saved)} bytes that Integrator.save has not made")
            _, kinked = _SAVED.unpack_from(saved)
            blob = ffi.from_buffer(saved)[_SAVED.size:len(saved)]
            with self._evaluate() as pointer:
                self._check(lib.corot_integrator_restore(pointer, blob, len(saved) - _SAVED.size))
                t = float(lib.corot_integrator_time(pointer))
                self._t, self._kinked, self._now = t, kinked, None


class FrameClock(Handle):
    """Carries a policy of frames out on one integrator: keywords as in corot_frame_policy: frames
    ("held" or "extrapolated"), every_step, interval [s], max_angle [rad], history, and hook, a function
    hook(t, u, v, drift) that is asked after each step and returns whether to update now. What it raises
    comes out of `tick`. u and v: where the integrator starts."""

    def __init__(self, integrator: Integrator, u: ArrayLike | None = None, v: ArrayLike | None = None, *,
                 hook: Callable[..., bool] | None = None, **policy: Any) -> None:
        state = integrator.state
        definition, keep = ffi.new("corot_frame_policy *"), []
        lib.corot_frame_policy_set_defaults(definition, ffi.sizeof("corot_frame_policy"))
        cv.fill(definition, policy, keep, "a policy of frames", ("hook", "hook_data"))
        if hook is not None:
            self._hook = _hook_callback(hook, state._n, integrator._pending)
            definition.hook = self._hook
        u = integrator.u if u is None else state._field(u)
        v = integrator.v if v is None else state._field(v, "v")
        out = ffi.new("corot_frame_clock **")
        with integrator._evaluate() as pointer:
            integrator._check(lib.corot_frame_clock_create(
                definition, state._m, state._pointer, pointer, integrator._t, cv.doubles(u),
                cv.doubles(v), out))
            self._open(out[0], lib.corot_frame_clock_destroy, integrator, guard=state._guard)
        self._integrator = integrator

    @property
    def stop(self) -> float:
        """The next time [s] at which the integrator must stop for an update; inf: none is fixed."""
        with self._guard:
            return float(lib.corot_frame_clock_stop(self._pointer))

    def tick(self) -> cv.Record:
        """Call this at the end of each step: updates the frames if it is time, and says why and by how
        much (corot_frame_event)."""
        out = ffi.new("corot_frame_event *")
        with self._integrator._evaluate():
            status = lib.corot_frame_clock_tick(self._pointer, self._integrator._t, out)
            self._integrator._check(status)
        return cv.Record("frame_event", {
            "reason": cv.word("corot_frame_reason", out.reason), "change": cv.record(out.change),
            "restarted": bool(out.restarted)})


def _hook_callback(hook: Callable[..., bool], n: int, pending: Pending) -> Any:
    def run(_data: Any, t: float, u: Any, v: Any, drift: Any) -> bool:
        try:
            arrays = (np.frombuffer(ffi.buffer(each, 8 * n), np.float64).copy() if n else np.zeros(0)
                      for each in (u, v))
            return bool(hook(t, *arrays, cv.record(drift)))
        except BaseException as error:  # noqa: BLE001: raised after the call
            pending.keep(error)
            return False
    return ffi.callback("corot_frame_hook *", run, error=False)


def methods() -> list[cv.Record]:
    """The methods of integration and what each is like (corot_method_kind)."""
    need("corot_method_at", "methods")
    return _list_kinds(lib.corot_method_at)
