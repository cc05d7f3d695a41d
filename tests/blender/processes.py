"""What the tests of Blender share."""
import shutil
import subprocess
import sys


def fail(why):
    sys.exit(why)


def run(*command, status=0):
    done = subprocess.run(command, capture_output=True, text=True, timeout=250)
    if done.returncode != status:
        fail("%s\nexit status %d instead of %d\n%s%s" % (" ".join(command), done.returncode, status, done.stdout, done.stderr))
    return done.stdout


def blender_or_skip():
    found = shutil.which("blender")
    if found is None:
        print("skipped: Blender is not installed")
        sys.exit(77)
    return found
