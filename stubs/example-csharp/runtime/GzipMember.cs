using System;
using System.IO;
using System.IO.Compression;
using System.Linq;

namespace FcRuntime
{
    /// <summary>
    /// Reads and writes one gzip member (RFC 1952), strictly. The library's streams ignore bytes after it, and some
    /// ignore its checksum.
    /// </summary>
    internal static class GzipMember
    {
        private const int Trailer = 8;

        /// <summary>
        /// Returns the content of a member. Throws <see cref="Fault"/> for anything except exactly one member, and once
        /// the content exceeds <c>most</c> bytes.
        /// </summary>
        internal static byte[] Unpack(byte[] member, long most)
        {
            var start = Header(member);
            var source = new Metered(member, start, member.Length - Trailer);
            var plain = new MemoryStream();
            var buffer = new byte[8192];
            try
            {
                using (var inflater = new DeflateStream(source, CompressionMode.Decompress))
                {
                    int count;
                    while ((count = inflater.Read(buffer, 0, buffer.Length)) > 0)
                    {
                        plain.Write(buffer, 0, count);
                        if (plain.Length > most)
                        {
                            throw new Fault(Faults.PlainLengthMismatch, most + " bytes are announced, and there are more");
                        }
                    }
                }
            }
            catch (Exception error) when (error is IOException || error is InvalidDataException)
            {
                throw new Fault(Faults.BadGzip, error.Message);
            }
            var data = plain.ToArray();
            var isSame = Number(member, member.Length - 8) == Crc(data);
            var isAll = source.IsUsedUp && Number(member, member.Length - 4) == (uint)data.Length;
            return isSame && isAll ? data : throw new Fault(Faults.BadGzip, "not one complete member");
        }

        internal static byte[] Pack(byte[] data)
        {
            var member = new MemoryStream();
            // Deflate, without flags or time, of an unknown system.
            member.Write(new byte[] { 0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255 }, 0, 10);
            using (var deflater = new DeflateStream(member, CompressionMode.Compress, true))
            {
                deflater.Write(data, 0, data.Length);
            }
            if (member.Length == 10)
            {
                // For empty data some libraries write nothing: write the empty block.
                member.Write(new byte[] { 3, 0 }, 0, 2);
            }
            foreach (var number in new[] { Crc(data), (uint)data.Length })
            {
                member.Write(new[] { (byte)number, (byte)(number >> 8), (byte)(number >> 16), (byte)(number >> 24) }, 0, 4);
            }
            return member.ToArray();
        }

        internal static uint Crc(byte[] data)
        {
            var crc = uint.MaxValue;
            foreach (var one in data)
            {
                crc = crc >> 8 ^ Table[(crc ^ one) & 0xff];
            }
            return ~crc;
        }

        private static readonly uint[] Table = Enumerable.Range(0, 256).Select(index =>
        {
            var crc = (uint)index;
            for (var bit = 0; bit < 8; bit++)
            {
                crc = (crc & 1) == 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
            }
            return crc;
        }).ToArray();

        private static uint Number(byte[] bytes, int at)
        {
            return bytes[at] | (uint)bytes[at + 1] << 8 | (uint)bytes[at + 2] << 16 | (uint)bytes[at + 3] << 24;
        }

        /// <summary>Returns the start of the compressed data.</summary>
        private static int Header(byte[] member)
        {
            const int shortest = 10 + Trailer;
            if (member.Length < shortest || member[0] != 0x1f || member[1] != 0x8b || member[2] != 8 || (member[3] & 0xe0) != 0)
            {
                throw new Fault(Faults.BadGzip, "no gzip");
            }
            var flags = member[3];
            var at = 10;
            if ((flags & 4) != 0)
            {
                at += 2 + member[at] + 256 * member[at + 1];
            }
            // A name and a comment, each ended by a zero byte.
            for (var flag = 8; flag <= 16; flag *= 2)
            {
                while ((flags & flag) != 0 && at < member.Length && member[at++] != 0)
                {
                }
            }
            at += (flags & 2) != 0 ? 2 : 0;
            return at < member.Length - Trailer ? at : throw new Fault(Faults.BadGzip, "the member is cut off");
        }

        /// <summary>
        /// Returns the last byte separately and notes any read after it. This shows if the compressed data ends there.
        /// </summary>
        private sealed class Metered : Stream
        {
            private readonly byte[] bytes;
            private readonly int end;
            private int at;
            private bool isAskedForMore;

            internal Metered(byte[] bytes, int start, int end)
            {
                this.bytes = bytes;
                this.end = end;
                at = start;
            }

            /// <c>true</c> if the compressed data ended exactly at its last byte.
            internal bool IsUsedUp => at == end && !isAskedForMore;

            public override int Read(byte[] buffer, int offset, int count)
            {
                isAskedForMore |= at == end;
                var given = Math.Min(count, Math.Max(end - at - 1, Math.Min(1, end - at)));
                Array.Copy(bytes, at, buffer, offset, given);
                at += given;
                return given;
            }

            public override bool CanRead => true;

            public override bool CanSeek => false;

            public override bool CanWrite => false;

            public override long Length => throw new NotSupportedException();

            public override long Position
            {
                get => throw new NotSupportedException();
                set => throw new NotSupportedException();
            }

            public override void Flush()
            {
            }

            public override long Seek(long offset, SeekOrigin origin)
            {
                throw new NotSupportedException();
            }

            public override void SetLength(long value)
            {
                throw new NotSupportedException();
            }

            public override void Write(byte[] buffer, int offset, int count)
            {
                throw new NotSupportedException();
            }
        }
    }
}
