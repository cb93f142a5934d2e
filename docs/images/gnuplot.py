"""What the scripts of pictures tell gnuplot: named data, and the size and file of a picture."""
import subprocess


def block(name, rows, digits=6):
    """Data that a plot command reads as $NAME, a row a line."""
    return f"${name} << EOD\n" + "".join(" ".join(f"{v:.{digits}g}" for v in row) + "\n" for row in rows) + "EOD\n"


def draw(picture, size, commands, options=""):
    """Runs commands; a picture *.svg becomes an SVG, another one a PNG. size: "WIDTH,HEIGHT" in pixels."""
    kind = "svg" if str(picture).endswith(".svg") else "pngcairo"
    head = f'set terminal {kind} size {size} {options} background "white" font "sans,13"\nset output "{picture}"\n'
    subprocess.run(["gnuplot"], input=head + commands, check=True, text=True)
