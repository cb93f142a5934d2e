"""A process that has set a locale with a comma as decimal point."""

import os
import shutil
import subprocess
import sys

import pytest

SCRIPT = """
import locale, sys, warnings
warnings.simplefilter("ignore")
import numpy as np
locale.setlocale(locale.LC_ALL, sys.argv[1])
comma = locale.localeconv()["decimal_point"]
import grainfield as gf
field = gf.import_field(sys.argv[2], height=0.0805, slope=30.5, rho_g=15000.5)
x, y = (a.ravel() * 0.0102 + 0.0051 for a in np.meshgrid(np.arange(8.0), np.arange(5.0)))
packing = gf.packing(x, y, np.full(40, 0.005), density=2500.5, walls=["floor:y=0.0", "left:x=0", "right:x=0.0816"],
                     friction=0.25)
engine = gf.Engine(packing, material=dict(law="linear", normal_stiffness=1.5e5, friction=0.25))
engine.step(2000)
mean = gf.average(engine.packing(), frame="packing", grid=(3, 3), width=0.0125)
model = gf.model("osl", phi_deg=30.5, rho_g=1.5, eta=0.75, mu=-0.25)
gf.write(sys.argv[3], mean)
print(comma, repr(field["sigma_yy"].tolist()), sorted(field.attributes.items()), repr(mean["sigma_yy"].tolist()),
      repr(model(np.array([[0.1, -0.5]])).tolist()), open(sys.argv[3]).read())
"""
TABLE = ("x (mm),component,value (kPa),error (kPa)\n-60.5,pressure,0.55,0.05\n-30.5,pressure,0.8,0.05\n"
         "0.5,pressure,1.05,0.05\n30.5,pressure,0.8,0.05\n60.5,pressure,0.55,0.05\n")


def test_numbers_are_the_same_under_a_comma(tmp_path):
    tool = shutil.which("localedef")
    made = tool and subprocess.run([tool, "-i", "de_DE", "-f", "UTF-8", str(tmp_path / "de_DE.UTF-8")],
                                   capture_output=True)
    if not made or not (tmp_path / "de_DE.UTF-8").exists():
        pytest.fail("localedef makes no de_DE.UTF-8: install the package locales")
    (tmp_path / "m.csv").write_text(TABLE)

    def told(name):
        done = subprocess.run([sys.executable, "-c", SCRIPT, name, str(tmp_path / "m.csv"), str(tmp_path / "f.csv")],
                              capture_output=True, text=True, env=os.environ | {"LOCPATH": str(tmp_path)})
        assert done.returncode == 0, done.stderr
        return done.stdout.split(" ", 1)

    (point, plain), (comma, german) = told("C"), told("de_DE.UTF-8")
    assert (point, comma) == (".", ",")
    assert german == plain
