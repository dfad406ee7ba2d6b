"""Speed against error: python3 -m calibration.benchmarks FOLDER."""
