"""A rock file from laboratory values: E, nu, UCS, tensile strength and, where known, toughness and confined strengths.

    python3 -m calibration.fit --youngs_modulus 18e9 --poissons_ratio 0.18 --ucs 60e6 --tensile_strength 7e6 --out DIR

--help lists all options. DIR/rock.json is the rock, for --rock of every scene; DIR/fit.md says how near it comes. A fit
that was interrupted goes on where it was when it is started again with the same words.
"""
import sys

from calibration.fitting.rock_fit import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
