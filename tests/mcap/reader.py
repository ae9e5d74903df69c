# SPDX-License-Identifier: Apache-2.0
"""Reads MCAP as https://mcap.dev/spec has it, and doubts everything: for tests."""

import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = 1, 2, 3, 4, 5, 6, 7, 8
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F


class Fields:
    """The fields of a record, one after the other; none may be left over."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, kind):
        (value,) = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize("<" + kind)
        return value

    def bytes(self, length_kind="I"):
        length = self.number(length_kind)
        assert self.at + length <= len(self.data), "a length that leaves its record"
        self.at += length
        return self.data[self.at - length : self.at]

    def text(self):
        return self.bytes().decode()

    def table(self, *kinds):
        inner, rows = Fields(self.bytes()), []
        while inner.at < len(inner.data):
            rows.append(tuple(inner.number(kind) for kind in kinds))
        return rows

    def end(self):
        assert self.at == len(self.data), "bytes left over"


def records(data, start, end):
    """(opcode, place, content) of each record; they fill the range."""
    while start < end:
        opcode, length = struct.unpack_from("<BQ", data, start)
        assert start + 9 + length <= end, "a record that leaves its place"
        yield opcode, start, data[start + 9 : start + 9 + length]
        start += 9 + length
    assert start == end


def read_message(content):
    f = Fields(content)
    return f.number("H"), f.number("I"), f.number("Q"), f.number("Q"), content[f.at :]


def read_schema(content):
    f = Fields(content)
    schema = f.number("H"), (f.text(), f.text(), f.text())
    f.end()
    return schema


def read_channel(content):
    f = Fields(content)
    channel = f.number("H"), (f.number("H"), f.text(), f.text())
    f.table("I")  # metadata
    f.end()
    return channel


class Mcap:
    """channels {id: (schema, topic, encoding)}, schemas {id: (name, encoding, text)}, and
    messages [(topic, sequence, time_ns, data)], once front to back and once by the index."""

    def __init__(self, data):
        assert data.startswith(MAGIC) and data.endswith(MAGIC), "no magic"
        self.data = data
        self.schemas, self.channels, self.messages = {}, {}, []
        self.chunks, self.index = {}, {}
        summary = self._read_data()
        self._read_summary(summary)

    def _read_data(self):
        end = len(self.data) - len(MAGIC)
        for opcode, at, content in records(self.data, len(MAGIC), end):
            if at == len(MAGIC):
                assert opcode == HEADER, "no header"
                f = Fields(content)
                self.profile, self.library = f.text(), f.text()
                f.end()
            elif opcode == SCHEMA:
                self.schemas.update([read_schema(content)])
            elif opcode == CHANNEL:
                number, channel = read_channel(content)
                assert channel[0] in self.schemas, "a channel before its schema"
                self.channels[number] = channel
            elif opcode == CHUNK:
                self.chunks[at] = self._read_chunk(content)
                last = at
            elif opcode == MESSAGE_INDEX:
                f = Fields(content)
                channel = f.number("H")
                self.index.setdefault(last, {})[channel] = (at, f.table("Q", "Q"))
                f.end()
            elif opcode == DATA_END:
                assert struct.unpack("<I", content)[0] == zlib.crc32(self.data[:at]), "data's checksum"
                return at + 9 + len(content)
            else:
                raise AssertionError(f"opcode {opcode} among the data")
        raise AssertionError("no end of the data")

    def _read_chunk(self, content):
        f = Fields(content)
        start, end, size, crc = f.number("Q"), f.number("Q"), f.number("Q"), f.number("I")
        assert f.text() == "", "compression"
        body = f.bytes("Q")
        f.end()
        assert len(body) == size and zlib.crc32(body) == crc, "chunk's checksum"
        times = []
        for opcode, at, message in records(body, 0, len(body)):
            assert opcode == MESSAGE
            channel, sequence, time, published, data = read_message(message)
            assert published == time
            self.messages.append((self.channels[channel][1], sequence, time, data))
            times.append(time)
        assert (start, end) == (min(times), max(times)), "chunk's times"
        return start, end, body

    def _read_summary(self, start):
        end = len(self.data) - len(MAGIC)
        *rest, (opcode, footer_at, footer) = records(self.data, start, end)
        assert opcode == FOOTER
        summary_start, offset_start, crc = struct.unpack("<QQI", footer)
        assert summary_start == start, "summary's place"
        assert crc == zlib.crc32(self.data[start : footer_at + 9 + 16]), "summary's checksum"
        groups, schemas, channels, by_index = {}, {}, {}, 0
        for opcode, at, content in rest:
            if opcode == SUMMARY_OFFSET:
                assert at >= offset_start
                f = Fields(content)
                group, place, length = f.number("B"), f.number("Q"), f.number("Q")
                f.end()
                assert groups.pop(group) == (place, place + length), "a group's place"
                continue
            first, last = groups.setdefault(opcode, (at, at))
            assert last == at, "records of one kind that do not follow each other"
            groups[opcode] = (first, at + 9 + len(content))
            if opcode == SCHEMA:
                schemas.update([read_schema(content)])
            elif opcode == CHANNEL:
                channels.update([read_channel(content)])
            elif opcode == STATISTICS:
                self._check_statistics(content)
            elif opcode == CHUNK_INDEX:
                self._check_chunk_index(content)
                by_index += 1
        assert not groups, "groups without an offset"
        assert (schemas, channels, by_index) == (self.schemas, self.channels, len(self.chunks))

    def _check_statistics(self, content):
        f = Fields(content)
        assert f.number("Q") == len(self.messages)
        assert (f.number("H"), f.number("I")) == (len(self.schemas), len(self.channels))
        assert (f.number("I"), f.number("I"), f.number("I")) == (0, 0, len(self.chunks))
        times = [time for _, _, time, _ in self.messages]
        assert (f.number("Q"), f.number("Q")) == (min(times), max(times))
        topics = [topic for topic, _, _, _ in self.messages]
        for channel, count in f.table("H", "Q"):
            assert count == topics.count(self.channels[channel][1])
        f.end()

    def _check_chunk_index(self, content):
        f = Fields(content)
        start, end, at, length = (f.number("Q") for _ in range(4))
        offsets, index_length = dict(f.table("H", "Q")), f.number("Q")
        assert f.text() == ""
        sizes = f.number("Q"), f.number("Q")
        f.end()
        first, last, body = self.chunks[at]
        assert (start, end) == (first, last) and sizes == (len(body), len(body))
        assert length == 9 + struct.unpack_from("<Q", self.data, at + 1)[0]
        found = 0
        for channel, (place, entries) in self.index[at].items():
            assert offsets[channel] == place and at + length <= place < at + length + index_length
            for time, offset in entries:
                opcode, size = struct.unpack_from("<BQ", body, offset)
                message = read_message(body[offset + 9 : offset + 9 + size])
                assert (opcode, message[0], message[2]) == (MESSAGE, channel, time), "index"
                found += 1
        assert found == sum(1 for _ in records(body, 0, len(body))), "messages without an index"
