"""How tests in Python end: what holds is said, what does not ends the test, and so does what is missing."""

import os
import sys


def skip(reason, required):
    """77, which ctest takes for skipped; a failure where the variable `required` is set."""
    print(f"skipped: {reason}")
    sys.exit(1 if os.environ.get(required) else 77)


def check(truth, what):
    if not truth:
        raise AssertionError(what)
    print(f"ok: {what}")
