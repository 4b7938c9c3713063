"""The command ``moorline``."""

import sys

from moorline._moorline import command


def main() -> int:
    return command(["moorline", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
