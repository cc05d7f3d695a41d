"""The field of spheres that the yardsticks render is the same for Backlight and for POV-Ray, and both read it.

    field_test.py SPHERE_FIELD BACKLIGHT FOLDER
"""

import os
import re
import shutil
import subprocess
import sys


def output(*command):
    run = subprocess.run(command, text=True, capture_output=True, check=False)
    if run.returncode != 0:
        sys.exit(f"field_test: {' '.join(command)}: exit status {run.returncode}\n{run.stdout}{run.stderr}")
    return run.stdout + run.stderr


def main():
    program, backlight, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    count = 37
    for motion in ("rest", "distinct", "4"):
        text = output(program, str(count), motion)
        if text.count('shape = "sphere"') != count:
            sys.exit(f"field_test: {text.count('shape =')} spheres of {count}, {motion}")
        path = os.path.join(folder, f"field-{motion}.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        output(backlight, "check", path)
    scene = output(program, str(count), "povray")
    if len(re.findall(r"\bsphere\s*{", scene)) != count:
        sys.exit("field_test: POV-Ray gets another number of spheres")
    path = os.path.join(folder, "field.pov")
    with open(path, "w", encoding="utf-8") as file:
        file.write(scene)
    if shutil.which("povray") is None:
        print("field_test: POV-Ray is not installed; its scene is not read")
        sys.exit(77)
    output("povray", "+I" + path, "+O" + os.path.join(folder, "field.png"), "+W16", "+H12", "-D")


if __name__ == "__main__":
    main()
