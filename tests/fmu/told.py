"""The FMU warns: each thing once, with time, value and what to do, in `logStatusWarning`; what has been told is part of the state."""

import math
import sys

from master import DISCARD, OK, WARNING, Fmu, Line, surge

fmu = Fmu(sys.argv[1])


def warnings(line: Line) -> list[str]:
    return [text for status, category, text in line.log if category == "logStatusWarning" and status == WARNING]


def told(line: Line, *words: str, times: int = 1):
    found = [text for text in warnings(line) if all(word in text for word in words)]
    assert len(found) == times, f"{words}: {line.log}"
    if found:
        print(found[0])


def moved(motion, steps: int, velocities=True, step: float = 0.1, **parameters) -> Line:
    line = Line(fmu)
    if parameters:
        assert line.set_real({name.replace("__", "."): value for name, value in parameters.items()}) == OK
    line.start(motion)
    for _ in range(steps):
        if line.step(motion, step, velocities) != OK:
            break
    return line


# A quiet run has nothing to tell.
told(moved(surge, 600), "", times=0)

# A fairlead that begins 70 m from where the scene has it.
line = moved(lambda t: ([70.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0] * 3), 5)
told(line, "70.0 m", "fairlead.position")

# A jump that the line survives.
told(moved(lambda t: ([0.0 if t < 1.0 else 8.0, 0.0, 0.0], [0.0] * 3, [0.0] * 3), 30), "t = 1.", "8.00 m")

# A line that slackens: let go along itself faster than what it carries can fall; and one that lifts its anchor: pulled out.
down = lambda t: ([5.0 * t * t, 0.0, -2.5 * t * t], [10.0 * t, 0.0, -5.0 * t], [0.0] * 3)
told(moved(down, 10), "slack", "kN at the fairlead")
farther = lambda t: ([-min(t, 32.0), 0.0, 0.0], [-1.0 if t < 32.0 else 0.0, 0.0, 0.0], [0.0] * 3)
told(moved(farther, 400), "lifts its anchor", "of it lay in equilibrium")

# Velocities of slow motion alone beside the whole position; told once, and the same after going back.
slow = lambda t: ([2.0 * math.sin(0.05 * t) + math.sin(0.8 * t), 0, 0], [0.1 * math.cos(0.05 * t), 0, 0], [0.0] * 3)
line = moved(slow, 300)
told(line, "velocities", "axis x")
status, state = line.get_state()
assert status == OK
before, time = len(warnings(line)), line.time
assert line.step(slow) == OK and line.set_state(state) == OK
line.time = time
assert line.step(slow) == OK
assert len(warnings(line)) == before

# And not believed: within the error of positions alone, where believing them is 5 %.
whole = lambda t: (slow(t)[0], [0.1 * math.cos(0.05 * t) + 0.8 * math.cos(0.8 * t), 0, 0], [0.0] * 3)
ends = [[], [], []]
for kept, motion, velocities in zip(ends, (whole, slow, whole), (True, True, False)):
    line = Line(fmu).start(motion)
    for number in range(800):
        assert line.step(motion, 0.1, velocities) == OK
        if number > 400:
            kept.append(line.get_real("tension")[1][0])
rms = lambda one, other: math.dist(one, other) / math.hypot(*one)
print(f"velocities of slow motion: {rms(ends[0], ends[1]):.2%} rms, positions alone {rms(ends[0], ends[2]):.2%}")
assert rms(ends[0], ends[1]) < 2.0 * rms(ends[0], ends[2]) + 2e-4

# A discarded step gives its reason as a warning, too.
line = moved(surge, 10)
assert line.set_real({"fairlead.velocity.x": -1400.0}) == OK
assert line.do_step(line.time, 3.0) == DISCARD, line.log
told(line, "was done only up to")

# Noise of a millimetre on positions that are measured every 0.1 s: with a filter at 0.5 Hz a tenth of what it makes without, and the delay
# that the filter is said to have, 1/(pi f).
DELAY = 1.0 / (math.pi * 0.5)


def noisy(size: float, cutoff: float) -> list[float]:
    line, seed, kept = Line(fmu), 1, []
    assert line.set_real({"input.filter": cutoff}) == OK
    line.start(surge)
    for number in range(900):
        shaken = []
        for place in surge(line.time)[0]:
            seed = (seed * 6364136223846793005 + 1442695040888963407) % 2**64
            shaken.append(place + size * math.sqrt(12.0) * (seed / 2**64 - 0.5))
        assert line.step(lambda time, at=shaken: (at, [0.0] * 3, [0.0] * 3), 0.1, False) == OK, line.log
        kept.append(line.get_real("tension")[1][0])
    return kept[600:]


smooth, late = noisy(0.0, 0.0), noisy(0.0, 0.5)
without, filtered = rms(noisy(1e-3, 0.0), smooth), rms(noisy(1e-3, 0.5), late)
shift = round(DELAY / 0.1)
print(f"1 mm of noise: {without:.2%} rms, filtered {filtered:.2%}; {rms(late[shift:], smooth[:-shift]):.2%} off what is {0.1 * shift:.1f} s older")
assert filtered < 0.15 * without and rms(late[shift:], smooth[:-shift]) < 0.02 < rms(late, smooth)
