using System;
using System.Collections.Generic;
using System.Linq;
using System.Security.Cryptography;

namespace FcRuntime
{
    /// <summary>Role of a header field.</summary>
    public enum HeaderRole
    {
        /// <summary>Sent with its value, and not interpreted.</summary>
        None,

        /// <summary>The bytes that open a frame.</summary>
        Head,

        /// <summary>Command, report or stream.</summary>
        Kind,

        /// <summary>The code of the operation.</summary>
        Code,

        /// <summary>Ties a response to its request.</summary>
        Id,

        /// <summary>Encoding of the data: plain or compressed.</summary>
        Encoding,

        /// <summary>Sent with its value, and not interpreted.</summary>
        Status,

        /// <summary>Header and data as sent, in bytes.</summary>
        TotalLength,

        /// <summary>Data before compression, in bytes.</summary>
        PlainLength,

        /// <summary>Fingerprint of the data as sent.</summary>
        Digest
    }

    /// <summary>A field of the header: place and length in bytes, and its default value.</summary>
    public struct HeaderField
    {
#pragma warning disable 1591
        public HeaderRole Role;
        public int Offset;
        public int Size;
        public ulong Value;
#pragma warning restore 1591
    }

    /// <summary>The layout of a protocol's frames.</summary>
    public sealed class Layout
    {
#pragma warning disable 1591
        public bool IsBigEndian;
        public HeaderField[] Header;
        public byte[] RequestHead;
        public byte[] ResponseHead;

        /// <summary>
        /// Kinds of frames by number: <c>command</c>, <c>report</c>, <c>stream</c> or <c>reserved</c>.
        /// </summary>
        public Dictionary<ulong, string> Kinds;

        public ulong Plain;

        /// <summary>The encoding of compressed frames; null for none.</summary>
        public ulong? Gzip;

        /// <c>true</c> if an uncompressed frame may have 0 as the length of its data.
        public bool IsZeroWhenPlain;

        /// <summary><c>md5</c> or <c>crc32</c>, if there is a digest.</summary>
        public string Digest;

        public long FrameBytes;
        public long InflatedBytes;
        public int JsonDepth;
#pragma warning restore 1591

        /// <summary>Length of the header in bytes.</summary>
        public int HeaderBytes => Header.Sum(field => field.Size);

        /// <summary>Returns the number of the kind: command, report or stream.</summary>
        public ulong KindOf(string role)
        {
            return Kinds.First(kind => kind.Value == role).Key;
        }

        internal HeaderField? Of(HeaderRole role)
        {
            var found = Header.Where(field => field.Role == role);
            return found.Any() ? found.First() : (HeaderField?)null;
        }

        internal byte[] Fingerprint(byte[] data)
        {
            if (Digest == "crc32")
            {
                return Bytes(GzipMember.Crc(data), 4);
            }
            using (var md5 = MD5.Create())
            {
                return md5.ComputeHash(data);
            }
        }

        internal byte[] Bytes(ulong value, int size)
        {
            var bytes = new byte[size];
            for (var at = 0; at < size; at++)
            {
                bytes[IsBigEndian ? size - 1 - at : at] = at < 8 ? (byte)(value >> (8 * at)) : (byte)0;
            }
            return bytes;
        }

        internal ulong Number(byte[] input, int start, HeaderField field)
        {
            ulong value = 0;
            for (var at = 0; at < field.Size; at++)
            {
                value = value << 8 | input[start + field.Offset + (IsBigEndian ? at : field.Size - 1 - at)];
            }
            return value;
        }
    }

    /// <summary>A frame: the header fields with a role, and the decompressed data.</summary>
    public sealed class Frame
    {
#pragma warning disable 1591
        public bool IsResponse;
        public ulong Kind;
        public uint Code;
        public uint Id;
        public byte[] Data;
#pragma warning restore 1591

        /// <summary>Up to this many plain bytes, any compression ratio is allowed.</summary>
        private const long FreelyInflated = 1 << 20;

        /// <summary>Greatest compression ratio of longer data.</summary>
        private const long MostInflated = 256;

        /// <summary>
        /// Reads the first frame of the input. Throws <see cref="Fault"/>. The order of the checks is part of the
        /// protocol.
        /// </summary>
        public static Frame Decode(Layout layout, byte[] input)
        {
            if (!Begins(input, layout.RequestHead) && !Begins(input, layout.ResponseHead))
            {
                throw new Fault(Faults.BadHead, "no frame begins so");
            }
            var length = layout.Of(HeaderRole.TotalLength).Value;
            if (input.Length < length.Offset + length.Size)
            {
                throw new Fault(Faults.Truncated, "the header is not whole");
            }
            var total = (long)layout.Number(input, 0, length);
            if (total < layout.HeaderBytes)
            {
                throw new Fault(Faults.ShortFrame, total + " bytes are less than the header");
            }
            if (total > layout.FrameBytes)
            {
                throw new Fault(Faults.FrameTooLong, total + " bytes; at most " + layout.FrameBytes);
            }
            if (input.Length < total)
            {
                throw new Fault(Faults.Truncated, total + " bytes are announced, and there are " + input.Length);
            }
            Func<HeaderRole, ulong?> read = role =>
            {
                var field = layout.Of(role);
                return field == null ? (ulong?)null : layout.Number(input, 0, field.Value);
            };
            var frame = new Frame
            {
                IsResponse = Begins(input, layout.ResponseHead),
                Kind = read(HeaderRole.Kind) ?? 0,
                Code = (uint)(read(HeaderRole.Code) ?? 0),
                Id = (uint)(read(HeaderRole.Id) ?? 0),
                Data = input.Skip(layout.HeaderBytes).Take((int)total - layout.HeaderBytes).ToArray()
            };
            string kind;
            if (!layout.Kinds.TryGetValue(frame.Kind, out kind))
            {
                throw new Fault(Faults.UnknownKind, "kind " + frame.Kind);
            }
            if (kind == "reserved")
            {
                throw new Fault(Faults.ReservedKind, "kind " + frame.Kind);
            }
            var encoding = read(HeaderRole.Encoding) ?? layout.Plain;
            if (encoding != layout.Plain && encoding != layout.Gzip)
            {
                throw new Fault(Faults.UnknownEncoding, "encoding " + encoding);
            }
            var digest = layout.Of(HeaderRole.Digest);
            if (digest != null && !layout.Fingerprint(frame.Data).SequenceEqual(input.Skip(digest.Value.Offset).Take(digest.Value.Size)))
            {
                throw new Fault(Faults.BadDigest, "the digest is another");
            }
            var plainLength = (long?)read(HeaderRole.PlainLength);
            if (encoding != layout.Plain)
            {
                if (plainLength > layout.InflatedBytes)
                {
                    throw new Fault(Faults.InflatedTooLong, plainLength + " bytes; at most " + layout.InflatedBytes);
                }
                // A limit of this runtime on the compression ratio of all frames except streams.
                if (kind != "stream" && plainLength > Math.Max(FreelyInflated, MostInflated * (long)frame.Data.Length))
                {
                    throw new Fault(Faults.InflatesTooMuch, frame.Data.Length + " bytes would become " + plainLength);
                }
                frame.Data = GzipMember.Unpack(frame.Data, plainLength ?? layout.InflatedBytes);
            }
            else if (plainLength == 0 && layout.IsZeroWhenPlain)
            {
                plainLength = null;
            }
            if (plainLength != null && plainLength != frame.Data.Length)
            {
                throw new Fault(Faults.PlainLengthMismatch, plainLength + " bytes are announced, and there are " + frame.Data.Length);
            }
            return frame;
        }

        /// <summary>
        /// Returns the bytes of the frame, compressed or not. Throws <see cref="Fault"/> if it is too long.
        /// </summary>
        public byte[] Encode(Layout layout, bool isPacked = false)
        {
            if (isPacked && layout.Gzip == null)
            {
                throw new Fault(Faults.UnknownEncoding, "the protocol does not compress");
            }
            var data = isPacked ? GzipMember.Pack(Data) : Data;
            var total = layout.HeaderBytes + data.Length;
            if (total > layout.FrameBytes)
            {
                throw new Fault(Faults.FrameTooLong, total + " bytes; at most " + layout.FrameBytes);
            }
            var bytes = new byte[total];
            foreach (var field in layout.Header)
            {
                Content(field, layout, data, isPacked).CopyTo(bytes, field.Offset);
            }
            data.CopyTo(bytes, layout.HeaderBytes);
            return bytes;
        }

        private byte[] Content(HeaderField field, Layout layout, byte[] data, bool isPacked)
        {
            switch (field.Role)
            {
                case HeaderRole.Head:
                    return IsResponse ? layout.ResponseHead : layout.RequestHead;
                case HeaderRole.Kind:
                    return layout.Bytes(Kind, field.Size);
                case HeaderRole.Code:
                    return layout.Bytes(Code, field.Size);
                case HeaderRole.Id:
                    return layout.Bytes(Id, field.Size);
                case HeaderRole.Encoding:
                    return layout.Bytes(isPacked ? layout.Gzip.Value : layout.Plain, field.Size);
                case HeaderRole.TotalLength:
                    return layout.Bytes((ulong)(layout.HeaderBytes + data.Length), field.Size);
                case HeaderRole.PlainLength:
                    return layout.Bytes((ulong)Data.Length, field.Size);
                case HeaderRole.Digest:
                    return layout.Fingerprint(data);
                default:
                    return layout.Bytes(field.Value, field.Size);
            }
        }

        /// <summary>Returns <c>true</c> if the input begins with a head, or with a part of one.</summary>
        private static bool Begins(byte[] input, byte[] head)
        {
            return input.Take(head.Length).SequenceEqual(head.Take(input.Length));
        }
    }
}
