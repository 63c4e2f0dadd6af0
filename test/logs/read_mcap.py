"""Reads an MCAP file with the MCAP project's own reader and prints what is in it as JSON.

Checks every CRC, reads once through the index and once straight through, and each message against its schema's types. Messages of Foxglove's
topics are also read by the classes of its published package, which accept no field that they don't know, and the schemas compared with them.
Exit code 77: zstandard is missing.
"""

import importlib
import json
import sys

try:
    import zstandard  # noqa: F401  the chunks' compression
except ImportError:
    print("read_mcap.py: the package zstandard is missing", file=sys.stderr)
    sys.exit(77)
from mcap.reader import make_reader
from mcap.records import Chunk, Message
from mcap.stream_reader import StreamReader

TYPES = {"integer": int, "number": (int, float), "boolean": bool, "string": str, "array": list, "object": dict}


def check(value, schema, path):
    if "oneOf" in schema:
        assert value in [one["const"] for one in schema["oneOf"]], f"{path}: {value!r} is none of the schema's constants"
        return
    if value is None and schema["type"] == "number":
        return  # no number
    assert isinstance(value, TYPES[schema["type"]]), f"{path}: {value!r} is no {schema['type']}"
    if schema["type"] == "array":
        for one in value:
            check(one, schema["items"], f"{path}[]")
    if schema["type"] == "object":
        names = list(schema["properties"])
        optional = set(names) - set(schema.get("required", names))
        assert [n for n in names if n in value or n not in optional] == list(value), f"{path}: other fields than the schema's"
        for name in value:
            check(value[name], schema["properties"][name], f"{path}.{name}")


def protobuf_time(value):
    """Foxglove's JSON has times as {sec, nsec}, protobuf's as a text."""
    if isinstance(value, list):
        return [protobuf_time(one) for one in value]
    if not isinstance(value, dict):
        return value
    if set(value) == {"sec", "nsec"}:
        from google.protobuf.timestamp_pb2 import Timestamp

        return Timestamp(seconds=value["sec"], nanos=value["nsec"]).ToJsonString()
    return {name: protobuf_time(part) for name, part in value.items()}


def published(schema_name):
    """What Foxglove's package says of a message, and a function that reads one as it does; None without the package."""
    try:
        from google.protobuf import json_format

        kind = schema_name.removeprefix("foxglove.")
        message = getattr(importlib.import_module(f"foxglove_schemas_protobuf.{kind}_pb2"), kind)
    except ImportError:
        return None

    def read(value):
        json_format.ParseDict(protobuf_time(value), message())

    return message.DESCRIPTOR, read


def compare(schema, descriptor, path):
    """The JSON schema has the fields, types and constants that the package says."""
    assert set(schema["properties"]) == set(descriptor.fields_by_name), f"{path}: {list(schema['properties'])}"
    for name, field in descriptor.fields_by_name.items():
        part, here = schema["properties"][name], f"{path}.{name}"
        if field.is_repeated:
            assert part["type"] == "array", here
            part = part["items"]
        if field.enum_type:
            assert {one["title"]: one["const"] for one in part["oneOf"]} == {one.name: one.number for one in field.enum_type.values}, here
        elif field.message_type is None:
            expected = {field.CPPTYPE_DOUBLE: "number", field.CPPTYPE_STRING: "string", field.CPPTYPE_UINT32: "integer"}[field.cpp_type]
            assert part["type"] == expected, here
        elif field.message_type.full_name == "google.protobuf.Timestamp":
            assert set(part["properties"]) == {"sec", "nsec"}, here
        else:
            compare(part, field.message_type, here)


topics, readers = {}, {}
with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, validate_crcs=True)
    summary = reader.get_summary()
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == "jsonschema" and channel.message_encoding == "json"
        value = json.loads(message.data)
        check(value, json.loads(schema.data), channel.topic)
        if schema.name.startswith("foxglove."):
            if schema.name not in readers:
                readers[schema.name] = published(schema.name)
                if readers[schema.name]:
                    compare(json.loads(schema.data), readers[schema.name][0], schema.name)
            if readers[schema.name]:
                readers[schema.name][1](value)
        topic = topics.setdefault(channel.topic, {"schema": schema.name, "count": 0, "first_ns": message.log_time, "first": value})
        assert message.sequence == topic["count"], channel.topic
        topic["count"] += 1
        topic["last_ns"] = message.log_time
        topic["last"] = value

with open(sys.argv[1], "rb") as stream:
    straight = sum(isinstance(record, Message) for record in StreamReader(stream, validate_crcs=True).records)
with open(sys.argv[1], "rb") as stream:
    compressions = {record.compression for record in StreamReader(stream, emit_chunks=True).records if isinstance(record, Chunk)}

statistics = summary.statistics
indexed = {summary.channels[i].topic: n for i, n in statistics.channel_message_counts.items()}
assert indexed == {name: topic["count"] for name, topic in topics.items()}
assert straight == statistics.message_count
print(
    json.dumps(
        {
            "topics": topics,
            "chunks": statistics.chunk_count,
            "compressions": sorted(compressions),
            "published": sorted(name for name, known in readers.items() if known),
            "start_ns": statistics.message_start_time,
            "end_ns": statistics.message_end_time,
        }
    )
)
