"""Checks that CHANGELOG.md and CITATION.cff name the version that CMake's project() sets.

Usage: check_version.py SOURCE_DIR VERSION. Oracle: the one source of the version, CMakeLists.txt.
"""

import re
import sys
from pathlib import Path


def first(pattern: str, path: Path) -> str:
    match = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    if match is None:
        sys.exit(f"{path.name}: nothing matches {pattern}")
    return match[1]


source_dir, version = Path(sys.argv[1]), sys.argv[2]
changelog = source_dir / "CHANGELOG.md"
citation = source_dir / "CITATION.cff"

stated = {
    "CHANGELOG.md": first(r"^## \[(\d[^]]*)\]", changelog),
    "CITATION.cff": first(r"^version: (\S+)$", citation),
}
wrong = [f"{name} says {said}, CMakeLists.txt {version}" for name, said in stated.items() if said != version]

# A version is released once its heading in the changelog has a date; the citation gives the same one.
date = first(rf"^## \[{re.escape(version)}\] - (\S+)$", changelog)
if date != "unreleased" and date != first(r"^date-released: (\S+)$", citation):
    wrong.append(f"CHANGELOG.md dates {version} {date}, CITATION.cff another day")

if wrong:
    sys.exit("\n".join(wrong))
print(f"{version} everywhere")
