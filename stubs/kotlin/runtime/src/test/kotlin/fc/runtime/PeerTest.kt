package fc.runtime

import java.util.concurrent.TimeUnit.DAYS
import java.util.concurrent.TimeUnit.MILLISECONDS
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.Job
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.launch

/** Runs the scripts of level `peer` against a whole app and a whole robot. */
internal fun peerTests(tests: Tests) {
    for (file in tests.files("conformance/sessions")) {
        val contents = Tree.of(file)
        if (contents["level"].text != "peer") continue
        for (script in contents["scripts"].items) {
            tests.case("${file.name}: ${script["name"].text}: ${script["demands"].text}", "peer") {
                val given = script["given"]
                val run = if (given["side"].text == "app") AppRun(given) else RobotRun(given)
                script["steps"].items.forEachIndexed { index, step -> run.step(index, step) }
            }
        }
    }
}

private val OUTCOMES = listOf("success", "protocol", "timeout", "invalid", "expired")

/** The common part of both sides: frames at the other end, and a clock. */
private abstract class PeerRun {
    class Sent(val name: String, val code: Int, var frame: FrameId? = null)

    class Arrived(val name: String, val frame: FrameId, val body: Tree)

    val loop = TestLoop()
    val scope = CoroutineScope(SupervisorJob() + Dispatchers.Unconfined)
    val got = ArrayList<String>()
    val sent = ArrayList<Sent>()
    val arrived = ArrayList<Arrived>()
    var wire: TestWire? = null

    abstract fun act(verb: String, said: Tree)

    abstract val inFlight: Int?

    fun limits(given: Tree): Limits = Toy.defaults.limits.inFlight(given.find("in_flight")?.int ?: 64)
        .queuedReports(given.find("queued_reports")?.int ?: 16)

    fun connect(): TestLink = TestWire(loop).also { wire = it }.link

    fun step(index: Int, step: Tree) {
        val (verb, said) = step.keys.entries.first { it.key != "expect" && it.key != "then" }
        when (verb) {
            "receive" -> receive(said)
            "advance" -> loop.advance(said.long)
            else -> act(verb, said)
        }
        // The peer may continue when the other end has closed, too.
        repeat(2) {
            loop.settle()
            drain()
        }
        val found = got.sorted()
        got.clear()
        val expected = step.find("expect")?.items.orEmpty().map { expected(it, found) }.sorted()
        expect(expected, found) { "step ${index + 1} ($verb):" }
        val then = step.find("then") ?: return
        expect(then["in_flight"].int, inFlight) { "step ${index + 1} in flight:" }
    }

    /** Returns an event in the format of `got`. Without an id, it takes the sent one. */
    private fun expected(event: Tree, found: List<String>): String {
        val (kind, said) = event.keys.entries.firstOrNull() ?: return event.text
        return when (kind) {
            "sends", "again" -> {
                val begin = "$kind ${said["as"].text} "
                said.find("id")?.let { begin + it.text } ?: found.firstOrNull { it.startsWith(begin) } ?: begin
            }
            "ends" -> "ends ${said["as"].text} ${said["with"].text}"
            "answers" -> "answers ${said["to"].text} ${said["result"].text}"
            else -> "$kind ${said.text}"
        }
    }

    private fun receive(said: Tree) {
        val request = said.find("answer_to")?.let { name -> sent.last { it.name == name.text }.frame!! }
        val kind = when (said.find("kind")?.text) {
            "command" -> Toy.commandKind
            "report" -> Toy.reportKind
            "stream" -> Toy.streamKind
            else -> request!!.kind
        }
        val code = said.find("code")?.int ?: request!!.code
        val frame = FrameId(request != null, kind, code, said.find("id")?.long ?: request!!.id)
        val own = when {
            said.find("broken")?.text == "true" -> "\"text\":1,\"metres\":\"\""
            request != null -> "\"result\":${OUTCOMES.indexOf(said.find("result")?.text ?: "success")},\"text\":\"\""
            code == Toy.ECHO.code -> "\"text\":\"\""
            else -> "\"metres\":1"
        }
        val body = "{$own${said.find("data")?.let { ",\"data\":\"${it.text}\"" } ?: ""}}"
        said.find("as")?.let { arrived.add(Arrived(it.text, frame, Tree.of(body))) }
        wire!!.send(frame, body)
    }

    fun nameOf(code: Int, id: Long, body: Tree?): String =
        arrived.lastOrNull { it.frame.code == code && it.frame.id == id && (body == null || body == it.body) }?.name
            ?: throw Wrong("nothing has arrived with code $code and id $id")

    private fun drain() {
        val wire = wire ?: return
        for (frame in wire.frames()) got.add(event(frame))
        if (wire.link.hasGone) {
            got.add("closes")
            wire.link.lose()
            this.wire = null
        }
    }

    private fun event(frame: Frame): String {
        val body = Tree.of(String(frame.body))
        if (frame.id.isResponse) {
            return "answers ${nameOf(frame.id.code, frame.id.id, null)} ${OUTCOMES[body["result"].int]}"
        }
        val request = sent[(body.find("metres") ?: body["text"]).int]
        val before = request.frame
        val kind = if (request.code == Toy.MOVED.code) Toy.reportKind else Toy.commandKind
        if (before == null && frame.id.kind == kind && frame.id.code == request.code) {
            request.frame = frame.id
            return "sends ${request.name} ${frame.id.id}"
        }
        expect(before, frame.id) { "${request.name} is sent again:" }
        return "again ${request.name} ${frame.id.id}"
    }
}

private class AppRun(given: Tree) : PeerRun() {
    private var dialled: ((Link?, Exception?) -> Unit)? = null
    private val core: ClientCore
    private val app: Connection
    private val receivers: List<Reports>
    private val calls = HashMap<String, Job>()

    init {
        val config = ClientConfig().limits(limits(given)).connectTimeout(365, DAYS)
            .reconnect(Backoff().first(0, MILLISECONDS).longest(0, MILLISECONDS)).firstId(given["first_id"].long)
            .callTimeout(given.find("call_timeout")?.long ?: 3000, MILLISECONDS)
        val dial = Dial { done ->
            dialled = done
            object : Timer {
                override fun cancel() {
                    dialled = null
                }
            }
        }
        core = ClientCore(Toy, config, loop, dial)
        app = Connection(core, dial)
        core.begin(isFirstOnly = true)
        loop.settle()
        reconnect()
        loop.settle()
        receivers = List(given.find("receivers")?.int ?: 1) { app.reports() }
        scope.launch {
            app.states().collect { state ->
                got.add(state.javaClass.simpleName.lowercase())
            }
        }
        got.clear()
    }

    private fun reconnect() {
        val done = dialled ?: throw Wrong("it does not connect")
        dialled = null
        done(connect(), null)
    }

    override val inFlight: Int get() = app.inFlight

    override fun act(verb: String, said: Tree) {
        when (verb) {
            "call" -> call(said)
            "cancel" -> calls.getValue(said.text).cancel()
            "lose" -> wire!!.also { wire = null }.link.lose()
            "reconnect" -> reconnect()
            "take" -> receivers.firstOrNull()?.poll()?.let {
                got.add("hands_on ${nameOf(it.code, it.id, Tree.of(it.json))}")
            }
            "close" -> app.close()
            else -> throw Wrong("an app cannot do that: $verb")
        }
    }

    private fun call(said: Tree) {
        val (name, code) = said["as"].text to said["code"].int
        val number = sent.size
        sent.add(Sent(name, code))
        var options = CallOptions()
        said.find("timeout")?.let { options = options.timeout(it.long, MILLISECONDS) }
        said.find("repeat")?.let { options = options.repeat(it.text == "true") }
        calls[name] = scope.launch {
            val with = try {
                if (code == Toy.ECHO.code) {
                    app.call(Toy.ECHO, Echo.of("$number"), options)
                } else {
                    app.call(Toy.GO, Go.of(number), options)
                }
                "success"
            } catch (error: CallError) {
                error.name
            }
            got.add("ends $name $with")
        }
    }
}

private class RobotRun(given: Tree) : PeerRun() {
    private val handlers = HashMap<String, CompletableDeferred<Long>>()
    private val core: ServerCore
    private val robot: Server

    init {
        val config = ServerConfig().limits(limits(given)).firstId(given["first_id"].long)
            .handlerTimeout(given.find("handler_timeout")?.long ?: 2000, MILLISECONDS)
        val service = Service()
            .on(Toy.ECHO) { context, request ->
                handled(context)
                EchoReply.of(request.text)
            }
            .on(Toy.GO) { context, _ ->
                handled(context)
                Done.of()
            }
        core = ServerCore(Toy, config, loop, service, scope)
        robot = Server(core, null, null)
        expect(true, core.serve(connect(), null))
        loop.settle()
    }

    private suspend fun handled(context: Context) {
        val end = CompletableDeferred<Long>()
        val name = nameOf(context.code, context.id, null)
        handlers[name] = end
        got.add("handles $name")
        val result = end.await()
        if (result != 0L) throw Refusal(result, "as the script says")
    }

    override val inFlight: Int? get() = null

    override fun act(verb: String, said: Tree) {
        when (verb) {
            "report" -> push(said)
            "lose" -> wire!!.also { wire = null }.link.lose()
            "reconnect" -> expect(true, core.serve(connect(), null))
            "finish" -> {
                val handler = handlers.remove(said["handler_of"].text)!!
                val result = said.find("result")
                if (result != null) handler.complete(OUTCOMES.indexOf(result.text).toLong())
                else handler.completeExceptionally(IllegalStateException("as the script says"))
            }
            "shutdown" -> scope.launch(start = CoroutineStart.UNDISPATCHED) {
                robot.shutdown(said["grace"].long, MILLISECONDS)
                got.add("over")
            }
            else -> throw Wrong("a robot cannot do that: $verb")
        }
    }

    private fun push(said: Tree) {
        val name = said["as"].text
        val number = sent.size
        sent.add(Sent(name, said["code"].int))
        scope.launch {
            val ended = robot.push(Audience.ALL, Toy.MOVED, Moved.of(number))
            got.add("ends $name ${ended.firstOrNull()?.outcome?.name?.lowercase() ?: "nobody"}")
        }
    }
}
