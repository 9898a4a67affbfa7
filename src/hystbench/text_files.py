"""Reading text files of users: what is no text in UTF-8 is told as what it is."""

from pathlib import Path

from hystbench.errors import InputError, nearest

_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_ARCHIVE = b"PK\x03\x04"
_SOME = 4096
"""Bytes at the start of a file that tell binary data from text."""


def read_text(path: str | Path, expected: str) -> str:
    """Read a text file in UTF-8, with or without a mark at its start.

    Parameters
    ----------
    path : str or Path
    expected : str
        What the file should be, for messages: ``a CSV file``.

    Raises
    ------
    InputError
        If there is no such file, it cannot be read, or it is no text in UTF-8.
    """
    content = _content(path, expected)
    if _is_utf_16(content):
        raise InputError(
            f"{path}: text in UTF-16; expected text in UTF-8: save it as UTF-8 "
            "(spreadsheets call it 'CSV UTF-8')"
        )
    _refuse_binary(path, content, f"{expected}, text in UTF-8")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(
            f"{path}: row {line}: the byte 0x{content[error.start]:02x} is no text in "
            "UTF-8; expected text in UTF-8: save it as UTF-8"
        ) from error


def decoded(path: str | Path, expected: str) -> tuple[str, str]:
    """Read a text file of an instrument: UTF-8, UTF-16 or Windows-1252.

    Parameters
    ----------
    path : str or Path
    expected : str
        What the file should be, for messages.

    Returns
    -------
    text : str
    encoding : str
        ``UTF-8``, ``UTF-16`` or ``Windows-1252``. The last is taken where the bytes
        are neither of the others.

    Raises
    ------
    InputError
        If there is no such file, it cannot be read, or it holds binary data.
    """
    content = _content(path, expected)
    if _is_utf_16(content):
        mark = content.startswith(_UTF_16)
        low_first = content[1::2][:_SOME].count(0) > content[::2][:_SOME].count(0)
        name = "utf-16" if mark else "utf-16-le" if low_first else "utf-16-be"
        try:
            return content.decode(name), "UTF-16"
        except UnicodeDecodeError as error:
            raise InputError(
                f"{path}: begins as text in UTF-16 and is cut off or damaged at byte "
                f"{error.start}; expected {expected}"
            ) from error
    _refuse_binary(path, content, expected)
    try:
        return content.decode("utf-8-sig"), "UTF-8"
    except UnicodeDecodeError:
        # Every byte is a letter there; what has none becomes a mark.
        return content.decode("cp1252", errors="replace"), "Windows-1252"


def _content(place: str | Path, expected: str) -> bytes:
    """Read the bytes of a file, or say why not."""
    path = Path(place)
    if path.is_dir():
        raise InputError(f"{path}: a folder; expected {expected}")
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file; {_beside(path, expected)}") from None
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: {said}; expected {expected}") from error


def _refuse_binary(path: str | Path, content: bytes, expected: str) -> None:
    if content.startswith(_ARCHIVE):
        raise InputError(
            f"{path}: a workbook or another archive; expected {expected}: save the "
            "sheet as 'CSV UTF-8'"
        )
    if b"\0" in content[:_SOME]:
        raise InputError(f"{path}: binary data; expected {expected}")


def _is_utf_16(content: bytes) -> bool:
    """Tell text in UTF-16 by its mark, or as every other byte of the start is zero."""
    if content.startswith(_UTF_16):
        return True
    some = content[:_SOME]
    half = len(some) // 2
    zeros = (some[::2].count(0), some[1::2].count(0))
    return half > 8 and max(zeros) > 0.9 * half and min(zeros) < 0.1 * half


def _kind(suffix: str) -> str:
    return suffix.lower().replace(".yml", ".yaml")


def _beside(path: Path, expected: str) -> str:
    """Name the file beside it that may be meant."""
    folder = path.parent
    if not folder.is_dir():
        return f"no folder {str(folder)!r} either; expected {expected}"
    kin = sorted(
        item.name
        for item in folder.iterdir()
        if item.is_file() and _kind(item.suffix) == _kind(path.suffix)
    )
    return nearest(path.name, kin) if kin else f"expected {expected}"
