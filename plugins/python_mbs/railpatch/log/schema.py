"""Protobuf classes and schemas of the run log's own messages, built from the channel table.

No generated code: the descriptors are made when they are first asked for. Units and meanings go
into the schema as comments of the fields, as if it had been compiled from a commented .proto file.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

from railpatch.log.channels import Field, Message, note

PACKAGE = "railpatch"
_Descriptor = descriptor_pb2.FieldDescriptorProto
_TYPES = {
    "double": _Descriptor.TYPE_DOUBLE,
    "uint32": _Descriptor.TYPE_UINT32,
    "string": _Descriptor.TYPE_STRING,
}

# numbers that protobuf's descriptor.proto gives to the parts of a descriptor; used in comment paths
_FILE_MESSAGES, _MESSAGE_FIELDS, _NESTED_MESSAGES = 4, 2, 3


@cache
def message_class(message: Message) -> Any:
    """The protobuf class of a message of the table."""
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file_descriptor(message))
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(f"{PACKAGE}.{message.name}"))


@cache
def schema_data(message: Message) -> bytes:
    """The schema as MCAP wants it: a serialised FileDescriptorSet, with comments."""
    return descriptor_pb2.FileDescriptorSet(file=[file_descriptor(message)]).SerializeToString()


def file_descriptor(message: Message) -> descriptor_pb2.FileDescriptorProto:
    """The .proto file of one message: nested messages inside it, comments attached."""
    file = descriptor_pb2.FileDescriptorProto(
        name=f"{PACKAGE}/{message.name}.proto", package=PACKAGE, syntax="proto3"
    )
    _describe(file.message_type.add(), message, f".{PACKAGE}.{message.name}")
    _comment(file.source_code_info, message, [_FILE_MESSAGES, 0])
    return file


def _describe(target: descriptor_pb2.DescriptorProto, message: Message, full_name: str) -> None:
    target.name = message.name
    for number, field in enumerate(message.fields, start=1):
        _describe_field(target, field, number, full_name)
        if isinstance(field.kind, Message) and _is_first(message, field):
            nested = f"{full_name}.{field.kind.name}"
            _describe(target.nested_type.add(), field.kind, nested)
    # protobuf wants the synthetic groups of optional fields after all others; there are no others
    for proto in target.field:
        if proto.proto3_optional:
            proto.oneof_index = len(target.oneof_decl)
            target.oneof_decl.add(name=f"_{proto.name}")


def _is_first(message: Message, field: Field) -> bool:
    """Whether no field before it is of the same message type, which is described once."""
    return next(other for other in message.fields if other.kind is field.kind) is field


def _describe_field(
    target: descriptor_pb2.DescriptorProto, field: Field, number: int, full_name: str
) -> None:
    repeated = field.size != 1
    proto = target.field.add(
        name=field.name,
        json_name=field.name,
        number=number,
        label=_Descriptor.LABEL_REPEATED if repeated else _Descriptor.LABEL_OPTIONAL,
    )
    if isinstance(field.kind, Message):
        proto.type = _Descriptor.TYPE_MESSAGE
        proto.type_name = f"{full_name}.{field.kind.name}"
    else:
        proto.type = _TYPES[field.kind]
        # presence is tracked, so that a missing number is absent and not zero
        proto.proto3_optional = not repeated


def _comment(info: descriptor_pb2.SourceCodeInfo, message: Message, path: list[int]) -> None:
    info.location.add(path=path, span=[0, 0, 0], leading_comments=f" {message.text}\n")
    nested = 0
    for index, field in enumerate(message.fields):
        info.location.add(
            path=[*path, _MESSAGE_FIELDS, index],
            span=[0, 0, 0],
            leading_comments=f" {note(field)}\n",
        )
        if isinstance(field.kind, Message) and _is_first(message, field):
            _comment(info, field.kind, [*path, _NESTED_MESSAGES, nested])
            nested += 1
