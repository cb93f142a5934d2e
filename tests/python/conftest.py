import os
import sys
from pathlib import Path

os.environ["MPLBACKEND"] = "Agg"  # no windows
sys.path.insert(0, str(Path(__file__).parent))
