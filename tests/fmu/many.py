"""Many instances at once, in threads, one after the other by the thousand, and an instance handed from thread to thread."""

import sys
import threading

from master import OK, Fmu, Line, motion_of, surge

fmu = Fmu(sys.argv[1])
motion = motion_of(fmu)


def run(line: Line, steps: int = 20) -> list:
    line.start(motion)
    for _ in range(steps):
        assert line.step(motion) == OK, line.log
    return line.outputs()


alone = run(Line(fmu))
lines = [Line(fmu) for _ in range(20)]
results = [None] * len(lines)


def work(index: int):
    results[index] = run(lines[index])


threads = [threading.Thread(target=work, args=(index,)) for index in range(len(lines))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert all(result == alone for result in results), "instances disturb each other"
for line in lines:
    line.free()

# Each call from another thread.
wanderer = Line(fmu).start(motion)
for _ in range(20):
    thread = threading.Thread(target=wanderer.step, args=(motion,))
    thread.start()
    thread.join()
assert wanderer.outputs() == alone
wanderer.free()


def memory() -> int:
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


def one():
    line = Line(fmu).start(motion)
    assert line.step(motion) == OK
    _, state = line.get_state()
    line.deserialize(line.serialize(state))
    line.free()


if sys.platform == "linux":
    # A whole mooring takes longer to begin with.
    count = 400 if motion is surge else 50
    for _ in range(count // 5):
        one()
    before = memory()
    for _ in range(count):
        one()
    growth = memory() - before
    assert growth < 1_000_000, f"{count} instances leave {growth} bytes behind"
    print(f"{count} instances leave {growth} bytes behind")
