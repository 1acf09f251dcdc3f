"""Folder of what is kept between processes, under the user's cache; nothing depends on it but time."""

import hashlib
import logging
import os
import stat
import tempfile
from pathlib import Path

__all__ = ["base_folder", "is_private", "prepared_folder", "read_kept", "write_kept"]

_LOG = logging.getLogger("pitchpoint")
_DIGEST = hashlib.sha256().digest_size


def base_folder() -> Path:
    """Folder of the package under the user's cache.

    Raises:
        RuntimeError: the user has no home, as in a container that runs under a number.
    """
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pitchpoint"


def prepared_folder(folder: Path) -> Path | None:
    """The folder, made if need be; None where it cannot be, or where others can write to it."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if is_private(folder):
            return folder
    except OSError:
        return None
    _LOG.warning(
        "%s can be written to by others and is not used; what it would keep is made anew", folder
    )
    return None


def is_private(folder: Path) -> bool:
    """True if nobody but the user and the administrator can put files there."""
    if not hasattr(os, "geteuid"):
        return True  # Windows keeps a user's folders to the user
    own = folder.stat()
    mine = own.st_uid == os.geteuid() and not own.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    return mine and not any(map(_open_to_all, folder.resolve().parents))


def _open_to_all(folder: Path) -> bool:
    """True if anybody could replace what lies in a folder."""
    mode = folder.stat().st_mode
    return bool(mode & stat.S_IWOTH) and not mode & stat.S_ISVTX


def read_kept(path: Path) -> bytes | None:
    """What `write_kept` kept; None if there is none, or it is damaged."""
    try:
        kept = path.read_bytes()
    except OSError:
        return None
    digest, content = kept[:_DIGEST], kept[_DIGEST:]
    return content if hashlib.sha256(content).digest() == digest else None


def write_kept(path: Path, content: bytes) -> None:
    """Keep a file with its digest, whole or not at all; where that fails it costs time, nothing else."""
    try:
        path.parent.mkdir(mode=0o700, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent)
        with os.fdopen(handle, "wb") as part:
            part.write(hashlib.sha256(content).digest() + content)
        os.replace(name, path)
    except OSError as error:
        _LOG.info("%s is not kept: %s", path.name, error)
