"""The scenes that have names, the package's and those of the folder ``scenes`` here; and what is wrong
with one."""

import difflib
from dataclasses import dataclass
from pathlib import Path

#: The scenes of the project by their names, with their models beside them.
SCENES: dict[str, Path] = {
    path.stem: path for path in sorted((Path(__file__).parent / "scenes").glob("*.toml"))
}


def named(name: str) -> Path:
    """The file of a scene; of a name that none has, an error says which are most like it."""
    here = Path("scenes")
    if name in SCENES:
        return SCENES[name]
    if (here / f"{name}.toml").is_file():
        return here / f"{name}.toml"
    known = sorted({*SCENES, *(path.stem for path in here.glob("*.toml"))})
    nearest = difflib.get_close_matches(name, known)
    names = f"; nearest: {', '.join(nearest)}" if nearest else f": {', '.join(known)}"
    raise FileNotFoundError(f'scene: found "{name}", allowed: a path, or a name{names}')


@dataclass(frozen=True, eq=False)
class Problem:
    """One thing wrong with a scene."""

    file: str
    """The scene's file, or where in the arguments it stands."""
    line: int | None
    """Line, counted from 1; None for what is not in a file."""
    key: str
    """The key with its section, such as `head.sides`."""
    found: str
    """What was found."""
    allowed: str
    """What is allowed."""

    def __repr__(self) -> str:
        quoted = (f'"{part}"' if isinstance(part, str) else part for part in vars(self).values())
        parts = (f"{name}={part}" for name, part in zip(vars(self), quoted))
        return f"Problem({', '.join(parts)})"
