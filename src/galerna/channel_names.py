"""Channels by name: our own, or the one that OpenFAST knows them by."""

from __future__ import annotations

import re
from collections.abc import Iterable
from fnmatch import fnmatchcase

from galerna.contract import Channel
from galerna.errors import did_you_mean

#: further names of OpenFAST for one quantity, with the number 1 for every blade and section
ALIASES = {
    "TipDxc1": "OoPDefl1",
    "TipDyc1": "IPDefl1",
    "TipDzb1": "TipDzc1",
    "TipRDzc1": "TwstDefl1",
    "TipRDzb1": "TwstDefl1",
    "TwrClrnc1": "TipClrnc1",
    "Tip2Twr1": "TipClrnc1",
    "RootFzb1": "RootFzc1",
    "RootMzb1": "RootMzc1",
    "RootMIP1": "RootMxc1",
    "RootMOoP1": "RootMyc1",
    "RootMEdg1": "RootMxb1",
    "RootMFlp1": "RootMyb1",
    "LSShftTq": "RotTorq",
    "LSShftMxa": "RotTorq",
    "LSShftMxs": "RotTorq",
    "LSSTipMxa": "RotTorq",
    "LSSTipMxs": "RotTorq",
    "LSShftFxa": "RotThrust",
    "LSShftFxs": "RotThrust",
    "LSShftPwr": "RotPwr",
    "LSSTipVxa": "RotSpeed",
    "HSShftV": "GenSpeed",
    "BlPitch1": "BldPitch1",
    "YawBrFzn": "YawBrFzp",
    "YawBrMzn": "YawBrMzp",
    "NacYawP": "NacYaw",
}
_ALIASES = {name.lower(): openfast for name, openfast in ALIASES.items()}


def matching(pattern: str, channels: Iterable[Channel]) -> tuple[Channel, ...]:
    """The channels with a name, or pattern with * and ?; OpenFAST's where none of ours fits.

    OpenFAST's names are taken in any case and for any blade, node or section: all of a channel
    is chosen.
    """
    found = tuple(channel for channel in channels if fnmatchcase(channel.name, pattern))
    if found:
        return found
    wanted = _numbered(pattern)
    wanted = _numbered(_ALIASES.get(wanted, wanted))
    return tuple(c for c in channels if c.openfast and fnmatchcase(_numbered(c.openfast), wanted))


def nearest(pattern: str, channels: Iterable[Channel]) -> str:
    """A sentence with the channels whose names, or names in OpenFAST, are like a pattern."""
    listed = tuple(channels)
    if any(channel.name.startswith(pattern) for channel in listed):
        return f"did you mean '{pattern}*'?"
    names = {channel.name for channel in listed} | {shown_openfast(channel) for channel in listed}
    hint = did_you_mean(re.sub(r"[*?]", "", pattern), _meant(pattern, names - {""}))
    return hint if hint.startswith("did") else "galerna channels CASE lists them"


def _meant(pattern: str, names: set[str]) -> set[str]:
    """What a pattern may mean: names, and their first or last words where it begins or ends so."""
    words = [name.split("_") for name in names]
    if pattern.endswith("*"):
        names = names | {"_".join(w[:n]) + "*" for w in words for n in range(1, len(w))}
    if pattern.startswith("*"):
        names = names | {"*" + "_".join(w[n:]) for w in words for n in range(1, len(w))}
    return names


def shown_openfast(channel: Channel) -> str:
    """OpenFAST's name of a channel, of the first blade and the first place along it."""
    return channel.openfast.format(blade=1, node=1) if channel.openfast else ""


def openfast_names(channel: Channel) -> str:
    """OpenFAST's names of a channel with # for the numbers, and its unit where they differ."""
    name = re.sub(r"\{[^}]*\}", "#", channel.openfast)
    same = channel.openfast_unit in ("", "-", channel.unit)
    return name if same or not name else f"{name} [{channel.openfast_unit}]"


def _numbered(name: str) -> str:
    """A name in lower case with 1 for every number and placeholder."""
    return re.sub(r"\{[^}]*\}|\d+", "1", name.lower())
