# SPDX-License-Identifier: Apache-2.0
"""python -m penumbra: the command line, the same program with the same arguments."""

import os
import pathlib
import sys


def main() -> None:
    program = pathlib.Path(__file__).parent.absolute() / "bin" / "penumbra"
    try:
        os.execv(program, ["penumbra", *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"penumbra: {program}: {error.strerror}; install the package again")


if __name__ == "__main__":
    main()
