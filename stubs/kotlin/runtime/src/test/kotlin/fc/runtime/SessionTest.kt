package fc.runtime

/** Runs the scripts of level `session`. */
internal fun sessionTests(tests: Tests) {
    for (file in tests.files("conformance/sessions")) {
        val contents = Tree.of(file)
        if (contents["level"].text != "session") continue
        for (script in contents["scripts"].items) {
            tests.case("${file.name}: ${script["name"].text}: ${script["demands"].text}", "session") {
                SessionRun(script["given"]).steps(script["steps"].items, 0)
            }
        }
    }
}

/** [Toy] with short ids that wrap around soon. */
private class ShortIds(bytes: Int) : Protocol() {
    override val name get() = "short"
    override val host get() = Toy.host
    override val commandPort get() = 0
    override val dataPort get() = 0
    override val header = HeaderLayout(
        true,
        listOf(
            HeaderField.of(HeaderRole.HEAD, 1), HeaderField.of(HeaderRole.KIND, 1), HeaderField.of(HeaderRole.CODE, 1),
            HeaderField.of(HeaderRole.ID, bytes), HeaderField.of(HeaderRole.TOTAL_LENGTH, 4),
        ),
    )
    override val requestHead get() = Toy.requestHead
    override val responseHead get() = Toy.responseHead
    override val streamKind get() = 0
    override val commandKind get() = 1
    override val reportKind get() = 3
    override val requestEnvelope get() = Toy.requestEnvelope
    override val responseEnvelope get() = Toy.responseEnvelope
    override val results get() = Toy.results
    override val defaults get() = Toy.defaults
    override val commands get() = Toy.commands
    override val reports get() = Toy.reports
}

/** A case without a script: ids of a single byte. */
internal fun idTests(tests: Tests) {
    tests.case("an id in flight is passed over when ids wrap around") {
        val session = Session<String>(ShortIds(1), Toy.defaults.limits, AckPolicy(1000, 0), 0)
        expect(0L, session.open(1, 100, AckPolicy(1_000_000, 0), 0, "slow")?.id)
        repeat(255) { turn ->
            val frame = session.open(1, 100, AckPolicy(1000, 0), 0, "quick")!!
            expect(turn + 1L, frame.id)
            session.cancel(frame)
        }
        expect(1L, session.open(1, 100, AckPolicy(1000, 0), 0, "after")?.id)
        expect(2, session.inFlight)
    }
    tests.case("no more than half of all ids are in flight") {
        val session = Session<Int>(ShortIds(1), Toy.defaults.limits.inFlight(1000), AckPolicy(1000, 0), 0)
        expect(128, (0 until 1000).count { session.open(1, 100, AckPolicy(1000, 0), 0, it) != null })
    }
}

private class SessionRun(given: Tree) {
    private val ack = given.find("ack").let { AckPolicy(it?.get("timeout")?.long ?: 2000, it?.get("retries")?.int ?: 3) }
    private val call = AckPolicy(given.find("call_timeout")?.long ?: 3000, 0)
    private val limits = Toy.defaults.limits.inFlight(given.find("in_flight")?.int ?: 64)
        .queuedReports(given.find("queued_reports")?.int ?: 16)
    private val protocol = if (given.find("id_bits")?.int == 16) ShortIds(2) else Toy
    private val session = Session<String>(protocol, limits, ack, given["first_id"].long)
    private var now = 0L
    private val requests = HashMap<String, FrameId>()
    private val arrived = HashMap<String, Pair<FrameId, ByteArray?>>()
    private val ended = HashSet<FrameId>()

    fun steps(steps: List<Tree>, round: Int) {
        for ((index, step) in steps.withIndex()) {
            val repeat = step.find("repeat")
            if (repeat != null) {
                for (inner in 0 until repeat["times"].int) steps(repeat["steps"].items, inner)
                continue
            }
            val got = step(step, round)
            val expected = step.find("expect")?.items.orEmpty().map { filled(it) }
            expect(expected.sorted(), got.sorted()) { "step ${index + 1}:" }
            val then = step.find("then") ?: continue
            then.find("in_flight")?.let { expect(it.int, session.inFlight) { "step ${index + 1} in flight:" } }
            if ("next_due" in then.keys) expect(then["next_due"].text, (session.nextDue()?.minus(now)).toString())
            then.find("next_due_by")?.let { expect(true, (session.nextDue() ?: Long.MAX_VALUE) - now <= it.long) }
        }
    }

    /** Returns an expected event with the id of its request. */
    private fun filled(event: Tree): String {
        val (kind, said) = event.keys.entries.firstOrNull() ?: return event.text
        if (kind != "sends" && kind != "again") return "$kind ${said.text}"
        val name = said["as"].text
        return "$kind $name ${said.find("id")?.text ?: requests[name]?.id}"
    }

    private fun step(step: Tree, round: Int): List<String> {
        for ((verb, kind) in listOf("call" to Toy.commandKind, "report" to Toy.reportKind)) {
            val said = step.find(verb) ?: continue
            val usual = if (verb == "call") call else ack
            val policy = AckPolicy(said.find("timeout")?.long ?: usual.timeout, said.find("retries")?.int ?: usual.retries)
            val name = said["as"].text
            val frame = session.open(kind, said["code"].int, policy, now, name) ?: return listOf("busy $name")
            if (frame.id in requests.filterKeys { it != name && !endedName(it) }.values.map { it.id }) throw Wrong("id in use")
            requests[name] = frame
            ended.remove(frame)
            return listOf("sends $name ${frame.id}")
        }
        step.find("receive")?.let { return receive(it, round) }
        step.find("advance")?.let { return advance(it.long) }
        step.find("lose")?.let { lose ->
            val keeps = lose.find("keeps")?.items.orEmpty().map { it.text }
            return session.endIf { it !in keeps }.map { over(it) }.map { "ended $it" }
        }
        step.find("cancel")?.let {
            val frame = requests.getValue(it.text)
            return if (session.cancel(frame)) listOf("ended ${over(it.text)}") else emptyList()
        }
        val handedOn = step.find("handed_on")
        if (handedOn != null) {
            val (frame, digest) = arrived.getValue(handedOn.text)
            session.handedOn(frame, digest, now)
        } else {
            step["reconnect"]
            session.reconnected()
        }
        return emptyList()
    }

    private fun endedName(name: String) = requests[name] in ended

    /** Checks that a request ends only once. */
    private fun over(name: String): String = name.also { expect(true, ended.add(requests.getValue(it))) { "$name ends again:" } }

    private fun receive(said: Tree, round: Int): List<String> {
        val request = said.find("answer_to")?.let { requests.getValue(it.text) }
        val kind = when (said.find("kind")?.text) {
            "command" -> Toy.commandKind
            "report" -> Toy.reportKind
            "stream" -> Toy.streamKind
            else -> request!!.kind
        }
        val id = said.find("id")?.long?.plus(if (request == null) round else 0)?.and(0xFFFF_FFFF) ?: request!!.id
        val frame = FrameId(request != null, kind, said.find("code")?.int ?: request!!.code, id)
        val digest = said.find("data")?.let { DigestAlgorithm.MD5.digest(it.text.toByteArray(), 0, it.text.toByteArray().size) }
        said.find("as")?.let { arrived[it.text] = frame to digest }
        return listOf(
            when (val meaning = session.receive(frame, digest, now)) {
                is Incoming.Answer -> "answer ${over(meaning.token)}"
                Incoming.Late -> "late"
                Incoming.Command -> "command"
                Incoming.Report -> "report"
                Incoming.Repeated -> "repeated"
                Incoming.Stream -> "stream"
            },
        )
    }

    private fun advance(time: Long): List<String> {
        now += time
        val due = generateSequence { session.due(now) }.toList()
        return due.map {
            expect(requests[it.token], it.frame)
            if (it is Due.Again) "again ${it.token} ${it.frame.id}" else "expired ${over(it.token)}"
        }
    }
}
