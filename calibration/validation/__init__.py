"""Long validations: python3 -m calibration.validation FOLDER."""
