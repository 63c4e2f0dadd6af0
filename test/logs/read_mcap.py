"""Reads an MCAP file with the MCAP project's own reader and prints what is in it as JSON.

Checks every CRC, reads once through the index and once straight through, and each message against its schema's types.
"""

import json
import sys

from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader

TYPES = {"integer": int, "number": (int, float), "boolean": bool, "string": str, "array": list, "object": dict}


def check(value, schema, path):
    if value is None and schema["type"] == "number":
        return  # no number
    assert isinstance(value, TYPES[schema["type"]]), f"{path}: {value!r} is no {schema['type']}"
    if schema["type"] == "object":
        assert list(value) == list(schema["properties"]), f"{path}: other fields than the schema's"
        for name, part in schema["properties"].items():
            check(value[name], part, f"{path}.{name}")


topics = {}
with open(sys.argv[1], "rb") as stream:
    reader = make_reader(stream, validate_crcs=True)
    summary = reader.get_summary()
    for schema, channel, message in reader.iter_messages():
        assert schema.encoding == "jsonschema" and channel.message_encoding == "json"
        value = json.loads(message.data)
        check(value, json.loads(schema.data), channel.topic)
        topic = topics.setdefault(channel.topic, {"count": 0, "first_ns": message.log_time, "first": value})
        assert message.sequence == topic["count"], channel.topic
        topic["count"] += 1
        topic["last_ns"] = message.log_time

with open(sys.argv[1], "rb") as stream:
    straight = sum(isinstance(record, Message) for record in StreamReader(stream, validate_crcs=True).records)

statistics = summary.statistics
indexed = {summary.channels[i].topic: n for i, n in statistics.channel_message_counts.items()}
assert indexed == {name: topic["count"] for name, topic in topics.items()}
assert straight == statistics.message_count
print(
    json.dumps({"topics": topics, "chunks": statistics.chunk_count, "start_ns": statistics.message_start_time, "end_ns": statistics.message_end_time})
)
