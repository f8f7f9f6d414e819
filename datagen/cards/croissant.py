"""The corpus described to search engines: Croissant metadata (version 1.0), a JSON-LD document."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from datagen.cards.facts import Facts
from datagen.corpus_files.index import PLACE_COLUMNS, index_path
from datagen.files.digest import file_hash
from datagen.files.places import INDEX, SHARDS
from labels.schema import LABELS

CONFORMS_TO = "http://mlcommons.org/croissant/1.0"
CONTEXT: dict[str, Any] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "cr": "http://mlcommons.org/croissant/",
    "dct": "http://purl.org/dc/terms/",
    "sc": "https://schema.org/",
    "citeAs": "cr:citeAs",
    "column": "cr:column",
    "conformsTo": "dct:conformsTo",
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "extract": "cr:extract",
    "field": "cr:field",
    "fileObject": "cr:fileObject",
    "fileSet": "cr:fileSet",
    "includes": "cr:includes",
    "recordSet": "cr:recordSet",
    "source": "cr:source",
}
TYPES = {"str": "sc:Text", "float64": "sc:Float", "int64": "sc:Integer", "bool": "sc:Boolean"}
# By version 1.0, beside what every corpus has; version is recommended.
REQUIRED = ("license", "url", "creator", "datePublished")


def croissant_text(folder: Path, facts: Facts, out: Path) -> str:
    """The JSON-LD text for the corpus in `folder`, to lie in `out`; terms that nobody stated are left out."""
    known = {name: value for name, value in _document(folder, facts, out).items() if value}
    return json.dumps(known, indent=1, ensure_ascii=False) + "\n"


def unstated(facts: Facts) -> tuple[str, ...]:
    """What Croissant requires and neither recipe nor SPEC states: who publishes a corpus has to add it."""
    stated = {"license": facts.terms.licence, "url": facts.terms.url}
    return tuple(name for name in REQUIRED if not stated.get(name))


def _document(folder: Path, facts: Facts, out: Path) -> dict[str, Any]:
    info, terms = facts.info, facts.terms
    return {
        "@context": CONTEXT,
        "@type": "sc:Dataset",
        "conformsTo": CONFORMS_TO,
        "name": info.name,
        "description": " ".join(part for part in (info.title, facts.summary) if part) or info.name,
        "license": terms.licence,
        "citeAs": terms.citation,
        "url": terms.url,
        "version": info.identity["recipe_hash"],
        "distribution": _files(folder, out),
        "recordSet": [_labels()],
    }


def _files(folder: Path, out: Path) -> list[dict[str, Any]]:
    """The files of the corpus, where they lie seen from `out`."""
    root = Path(os.path.relpath(folder.resolve(), out.resolve()))
    index = {
        "@type": "cr:FileObject",
        "@id": INDEX,
        "name": INDEX,
        "description": "All labels, one row a record.",
        "contentUrl": (root / INDEX).as_posix(),
        "encodingFormat": "text/csv",
        "sha256": file_hash(index_path(folder)),
    }
    shards = {
        "@type": "cr:FileSet",
        "@id": SHARDS,
        "name": SHARDS,
        "description": "Signals and labels; manifest.json has the SHA-256 of each file.",
        "encodingFormat": "application/x-netcdf",
        "includes": (root / SHARDS / "*.nc").as_posix(),
    }
    return [index, shards]


def _labels() -> dict[str, Any]:
    columns = [(column, TYPES[label.dtype], label.sentence) for label in LABELS for column in label.columns]
    places = [("sc:Text", "File of the record's signals."), ("sc:Integer", "Place of the record in that file.")]
    columns += [(name, *place) for name, place in zip(PLACE_COLUMNS, places, strict=True)]
    fields = [
        {
            "@type": "cr:Field",
            "@id": f"records/{name}",
            "name": name,
            "description": sentence,
            "dataType": kind,
            "source": {"fileObject": {"@id": INDEX}, "extract": {"column": name}},
        }
        for name, kind, sentence in columns
    ]
    return {"@type": "cr:RecordSet", "@id": "records", "name": "records", "field": fields}
