"""One publication: as a line, as BibTeX."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Reference:
    """One publication; ``venue`` is journal, volume and pages, or institution and number."""

    key: str
    authors: str
    year: int
    title: str
    venue: str
    doi: str = ""
    kind: str = "article"

    @property
    def text(self) -> str:
        """The reference in one line."""
        end = f" doi:{self.doi}" if self.doi else ""
        return f"{self.authors} ({self.year}): {self.title}. {self.venue}.{end}"

    @property
    def bibtex(self) -> str:
        """The reference as a BibTeX entry."""
        venue = {"article": "journal", "book": "publisher"}.get(self.kind, "institution")
        fields = {
            "author": self.authors.replace(", ", " and "),
            "title": f"{{{self.title}}}",
            "year": str(self.year),
            venue: self.venue,
            "doi": self.doi,
        }
        body = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items() if value)
        return f"@{self.kind}{{{self.key},\n{body}\n}}"
