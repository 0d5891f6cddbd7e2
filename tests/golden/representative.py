#!/usr/bin/python3
"""Method paper on the representative points of the examples, labelled and partly coincident.

Oracle: check_report.py (the definitions: no violation).
"""
from pathlib import Path

import golden
import real_models

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def main():
    options = golden.arguments(__doc__).parse_args()
    checker_module = golden.specification(options.shared, "check_report")
    names = sorted(EXAMPLES.glob("*.step")) if options.full else [EXAMPLES / f"{name}.step" for name in ("flange", "bracket")]
    wrong = []
    for path in names:
        report = golden.detect(options.insym, path, 1e-4, points="representative")
        bad, cycles, symmetries = real_models.violations(checker_module, report, 60)
        print(f"{path.name}: {len(report['points'])} points, checked {cycles} cycles and {symmetries} symmetries: "
              f"{len(bad)} violations", flush=True)
        wrong += bad
    print("\n".join(wrong[:60]))
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
