"""One example of every block, which the contract and the model tests share.

A new block needs a line here; the contract test says so.
"""

from pathlib import Path

EXAMPLES = {
    "drag": {"coefficient": 0.3},
    "exponential-stiffness": {"coefficient": 20.0, "reach": 0.01},
    "friction-force": {
        "coulomb": 0.1,
        "presliding_distance": 1e-4,
        "static_excess": 0.05,
        "stribeck_velocity": 0.3,
    },
    "gravity": {"amplitude": 2.0, "angle": 0.3},
    "hysteretic-force": {"largest": 0.2, "yield_distance": 1e-3, "sharing": 0.6},
    "other-modes": {
        "numerator": [3.0, 50.0],
        "denominator": [1.0, 4.0, 900.0],
        "hold": "linear",
    },
    "logarithmic-creep": {
        "magnitude": 0.1,
        "first_time_s": 0.01,
        "last_time_s": 5.0,
        "power": 0.2,
    },
    "mechanism": {"mass": 0.002, "damping": 0.2, "stiffness": 100.0},
    "impedance": {"mass": 1e-4, "damping": 0.05, "stiffness": 3.0, "bias": 0.2},
    "slider-with-gap": {"contact_stiffness": 80.0, "slip_force": 0.1, "gap": 5e-4},
    "smooth-friction": {"coulomb": 0.1, "velocity_scale": 0.2},
    "stiffness": {"quadratic": 500.0, "cubic": 1e5},
    "stop": {"contact_stiffness": 300.0, "gap": 2e-3, "centre": 1e-4},
    "store": {"gain": 2.0, "rate": 0.5, "height": 1.0, "caught": 0.5},
    "asymmetry": {"coefficient": 0.02},
    "backlash": {"half_width": 0.1},
    "butterfly": {"coefficient": 0.4, "threshold": 0.1},
    "calibration-error": {"gain": 1.05, "offset": 0.1},
    "command": {"command": "cut -d, -f2"},
    "creep": {"magnitudes": [0.05, 0.03], "time_constants_s": [0.2, 2.0]},
    "dead-zone": {"half_width": 0.05},
    "drift": {"slope": 0.5, "path": [0.1, -0.2, 0.05]},
    "drive-lag": {"time_constant_s": 0.002},
    "drive-saturation": {"limit": 0.5},
    "eddy-diffusion": {"time_constant_s": 0.003},
    "fmu": {"file": "lag.fmu"},
    "friction": {"coulomb": 2.0, "velocity_scale": 5.0},
    "gain": {"value": 12.0, "offset": 0.5},
    "gpi": {
        "envelope": [1.2878, 0.36, 0.6025, -0.6671, 0.3223, 1.2233, 0.1104, -0.0248],
        "thresholds": [0.0, 0.05, 0.1],
        "weights": [1.0, 0.5, 0.25],
    },
    "hysteresis": {
        "envelope": [1.0, 0.9, 0.2, 0.0, 0.9, 1.0, 0.1, -0.1],
        "thresholds": [0.0, 0.1],
        "weights": [2.0, -0.5],
    },
    "hysteresis-shape": {
        "thresholds": [0.05, 0.2],
        "weights": [0.3, -0.1],
        "square_weights": [0.02, 0.05],
        "powers": [0.1, 0.0, -0.05],
    },
    "input-delay": {"delay_s": 0.00123},
    "jiles-atherton": {
        "saturation": 40.0,
        "shape": 0.5,
        "coupling": 0.3,
        "pinning": 0.1,
        "reversibility": 0.3,
        "bias": 0.2,
    },
    "mains-pickup": {
        "frequency_hz": 50.0,
        "amplitudes": [0.1, 0.02],
        "phases": [0.5, -1.0],
    },
    "onnx": {"file": str(Path(__file__).with_name("files") / "rnn.onnx")},
    "prandtl-ishlinskii": {
        "thresholds": [0.0, 0.1, 0.3],
        "weights": [-0.1, 0.3, -0.05],
        "square_weights": [0.1, -0.02, 0.03],
        "cube_weights": [0.0, 0.02, 0.1],
    },
    "preisach": {
        "limit": 0.8,
        "reversible": 5.0,
        "weights": [10.0, 3.0],
        "centres": [0.0, -0.2],
        "centre_spreads": [0.4, 0.1],
        "half_widths": [0.0, 0.2],
        "half_width_spreads": [0.1, 0.1],
    },
    "rate-dependent-hysteresis": {"coefficient": 0.02, "exponent": 0.7},
    "rdgpi": {
        "alpha1": 8.0,
        "beta1": 1.002,
        "lambda1": 2.5e-6,
        "alpha2": 0.08,
        "beta2": 1.25,
        "lambda2": 0.01,
        "c": 1.2,
        "rho": 3.3,
        "tau": 0.2,
        "envelope_gain": 7.0,
        "envelope_offset": -0.13,
    },
    "resonance": {"frequency_hz": 65.0, "damping_ratio": 0.03, "participation": 0.1},
    "saturation": {"level": 1.5},
    "sensor-lag": {"time_constant_s": 0.001},
    "sensor-noise": {"rms": 0.05},
    "sensor-nonlinearity": {"quadratic": -0.01, "cubic": 0.002},
    "slew-limit": {"rate": 100.0},
    "stiffness-hardening": {
        "coefficient": 0.3,
        "frequency_hz": 65.0,
        "damping_ratio": 0.03,
        "participation": 0.4,
    },
    "thermal-drift": {"coefficient": 0.3, "time_constant_s": 2.0},
    "external": {"function": "tests.blocks.examples:twice"},
    "simulated-column": {"column": "simulated_um"},
    "transfer-function": {
        "numerator": [1.0e3, 4.0e5],
        "denominator": [1.0, 1.2e3, 4.0e5],
    },
}


def twice(u, dt):
    """Stand for a simulator that a user brings."""
    return 2 * u
