package fc.runtime

import java.io.File

/** The vectors as frames: `frames.json`, and the frames of every operation. */
internal fun frameTests(tests: Tests) {
    val frameErrors = FrameErrorKind.entries.map { it.text }
    for (file in tests.files("fc-generated/vectors")) {
        if (file.name == "bodies.json") continue
        val vectors = Tree.of(file)
        val kind = "frames".takeIf { file.name == "frames.json" }
        for (case in vectors["accepted"].items) {
            val frame = hex(case.find("frame")?.text ?: continue)
            tests.case("${file.name}: ${case["name"].text}", kind) { accepted(frame, case) }
        }
        for (case in vectors["rejected"].items) {
            val frame = hex(case.find("frame")?.text ?: continue)
            val error = case["error"].text.takeIf { it in frameErrors }
            tests.case("${file.name}: ${case["name"].text}", kind) {
                expect(error, firstError(listOf(frame)))
                expect(error, firstError(frame.map { byteArrayOf(it) })) { "byte by byte:" }
            }
        }
    }
}

private fun decode(pieces: List<ByteArray>): Pair<List<Frame>, Decoder> {
    val decoder = Decoder(Toy, Toy.defaults.limits)
    val frames = ArrayList<Frame>()
    for (piece in pieces) {
        decoder.push(piece, 0, piece.size)
        while (true) frames.add(decoder.next() ?: break)
    }
    return frames to decoder
}

private fun firstError(pieces: List<ByteArray>): String? = errorOf { decode(pieces).second.finish()?.let { throw it } }

private fun accepted(bytes: ByteArray, case: Tree) {
    val (frames, decoder) = decode(listOf(bytes))
    expect(null, decoder.finish())
    expect(1, frames.size)
    val frame = frames[0]
    expect(hex(frame.body), hex(decode(bytes.map { byteArrayOf(it) }).first[0].body))
    case.find("header")?.let { header ->
        val found = listOf(frame.id.kind, frame.id.code, frame.id.id, frame.encoding, frame.plainLength, hex(frame.digest))
        val keys = listOf("kind", "code", "id", "encoding", "plain_length", "digest")
        expect(keys.map { header[it].text }, found.map { it.toString() })
    }
    case.find("data")?.let { expect(it.text, hex(frame.body)) }
    val again = Encoder(Toy, 1L shl 24, Gzip(0, 1).takeIf { frame.encoding == 1 }).prepare(frame.body).frame(frame.id)
    // A plain length of 0 and a status are accepted, but not sent.
    if (frame.encoding == 0 && bytes[10] == 0.toByte() && frame.plainLength == frame.body.size.toLong()) expect(hex(bytes), hex(again))
    expect(hex(frame.body), hex(decode(listOf(again)).first[0].body))
}

/** Cases without vectors: limits just below, at and above, searches, and false lengths. */
internal fun decoderTests(tests: Tests) {
    fun error(frame: ByteArray, limits: Limits = Toy.defaults.limits): String? = errorOf {
        val decoder = Decoder(Toy, limits)
        decoder.push(frame, 0, frame.size)
        generateSequence { decoder.next() }.count()
        decoder.finish()?.let { throw it }
    }

    val id = FrameId(false, 1, 5, 7)
    val limits = Toy.defaults.limits
    val plain = Encoder(Toy, 1L shl 24, null).prepare(ByteArray(100)).frame(id)
    for ((limit, expected) in listOf(134L to "frame_too_long", 135L to null, 136L to null)) {
        tests.case("a frame of 135 bytes and a limit of $limit") { expect(expected, error(plain, limits.frameBytes(limit))) }
        tests.case("sending 135 bytes with a limit of $limit") {
            expect(expected, errorOf { Encoder(Toy, limit, null).prepare(ByteArray(100)) })
        }
    }
    val packed = Encoder(Toy, 1L shl 24, Gzip(0, 9)).prepare(ByteArray(2 shl 20)).frame(id)
    val size = 2L shl 20
    for ((limit, expected) in listOf(size - 1 to "inflated_too_long", size to null)) {
        tests.case("inflated to $size with a limit of $limit") {
            expect(expected, error(packed, limits.inflatedBytes(limit).inflateRatio(5000)))
        }
    }
    tests.case("zeros inflate too much") { expect("inflates_too_much", error(packed)) }
    tests.case("but not in a stream") {
        expect(null, error(Encoder(Toy, 1L shl 24, Gzip(0, 9)).prepare(ByteArray(2 shl 20)).frame(FrameId(false, 0, 5, 7))))
    }
    tests.case("nothing is compressed that does not get shorter") {
        expect(null, deflated(java.util.Random(5).let { random -> ByteArray(2000).also(random::nextBytes) }, 9))
    }
    tests.case("garbage between frames is searched through") {
        val garbage = "garbage \u00FC\u00AA and more".toByteArray(Charsets.ISO_8859_1)
        val decoder = Decoder(Toy, limits, resync = true)
        val bytes = garbage + plain + garbage + plain
        val found = bytes.sumOf { byte ->
            decoder.push(byteArrayOf(byte), 0, 1)
            generateSequence { decoder.next() }.count()
        }
        expect(2, found)
    }
    tests.case("a wrong head is fatal for good") {
        val decoder = Decoder(Toy, limits)
        decoder.push(byteArrayOf(1), 0, 1)
        expect("bad_head", errorOf { decoder.next() })
        decoder.push(plain, 0, plain.size)
        expect("bad_head", errorOf { decoder.next() })
    }
    tests.case("digests need not be verified") {
        val damaged = plain.copyOf().also { it[40] = 9 }
        expect("bad_digest", error(damaged))
        val decoder = Decoder(Toy, limits, verifyDigest = false)
        decoder.push(damaged, 0, damaged.size)
        expect(9, decoder.next()?.body?.get(5)?.toInt())
    }
    tests.case("little end first, and CRC-32") {
        val layout = HeaderLayout(false, listOf(
            HeaderField.of(HeaderRole.HEAD, 1), HeaderField.of(HeaderRole.KIND, 1), HeaderField.of(HeaderRole.CODE, 2),
            HeaderField.of(HeaderRole.ID, 2), HeaderField.of(HeaderRole.TOTAL_LENGTH, 4), HeaderField.digest(DigestAlgorithm.CRC32),
        ))
        val header = Header(FrameId(false, 1, 0x102, 0x304), 0, 9, DigestAlgorithm.CRC32.digest("123456789".toByteArray(), 0, 9))
        val written = layout.write(byteArrayOf(7), header, 23)
        expect("07010201040317000000" + "2639f4cb", hex(written))
        expect("cbf43926", hex(layout.read(written, 0, false).digest))
        expect(0xFFFFL, layout.idMax)
    }
}

/** All languages share the names of errors. */
internal fun nameTests(tests: Tests) {
    val listed = Tree.of(File(tests.root, "conformance/errors.json"))["errors"].items
    for ((where, own) in listOf(
        "frame" to FrameErrorKind.entries.map { it.text },
        "body" to BodyErrorKind.entries.map { it.text },
        "call" to CallErrorKind.entries.map { it.text },
    )) {
        val here = listed.filter { it["where"].text == where }
        tests.case("the names of errors of a $where") { expect(here.map { it["name"].text }.sorted(), own.sorted()) }
        // Other implementations need not have a limit that is specific to this one.
        for (error in here.filter { it.find("own_limit") == null }) {
            val name = error["name"].text
            tests.case("the error $name", "${where}_errors") { expect(true, name in own) }
        }
    }
}
