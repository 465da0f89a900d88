/* `python -m scripts.browser` made this from scripts/browser/page, c02e4e28b1bfdbda7e1049d625a91c97680d02eb8fc4cca47d855f3c7c97124f */
(()=>{var J_=Object.create;var kh=Object.defineProperty;var K_=Object.getOwnPropertyDescriptor;var Q_=Object.getOwnPropertyNames;var e0=Object.getPrototypeOf,t0=Object.prototype.hasOwnProperty;var n0=(i=>typeof require<"u"?require:typeof Proxy<"u"?new Proxy(i,{get:(e,t)=>(typeof require<"u"?require:e)[t]}):i)(function(i){if(typeof require<"u")return require.apply(this,arguments);throw Error('Dynamic require of "'+i+'" is not supported')});var i0=(i,e,t,n)=>{if(e&&typeof e=="object"||typeof e=="function")for(let s of Q_(e))!t0.call(i,s)&&s!==t&&kh(i,s,{get:()=>e[s],enumerable:!(n=K_(e,s))||n.enumerable});return i};var r0=(i,e,t)=>(t=i!=null?J_(e0(i)):{},i0(e||!i||!i.__esModule?kh(t,"default",{value:i,enumerable:!0}):t,i));var s0=(async function(i={}){var e,t=i,n=typeof window=="object",s=typeof WorkerGlobalScope<"u",o=typeof process=="object"&&process.versions?.node&&process.type!="renderer",c=!n&&!o&&!s;if(o){let{createRequire:r}=await import("module");var u=r("file:///x")}var f=[],d="./this.program",m=(r,a)=>{throw a},y="file:///x",g="";function S(r){return t.locateFile?t.locateFile(r,g):g+r}var E,C;if(o){if(!(typeof process=="object"&&process.versions?.node&&process.type!="renderer"))throw new Error("not compiled for this environment (did you build to HTML and try to run it not on the web, or set ENVIRONMENT to something - like node - and run it someplace else - like on the web?)");var x=process.versions.node,v=x.split(".").slice(0,3);if(v=v[0]*1e4+v[1]*100+v[2].split("-")[0]*1,v<16e4)throw new Error("This emscripten-generated code requires node v16.0.0 (detected v"+x+")");var P=u("fs");y.startsWith("file:")&&(g=u("path").dirname(u("url").fileURLToPath(y))+"/"),C=a=>{a=ne(a)?new URL(a):a;var l=P.readFileSync(a);return G(Buffer.isBuffer(l)),l},E=async(a,l=!0)=>{a=ne(a)?new URL(a):a;var h=P.readFileSync(a,l?void 0:"utf8");return G(l?Buffer.isBuffer(h):typeof h=="string"),h},process.argv.length>1&&(d=process.argv[1].replace(/\\/g,"/")),f=process.argv.slice(2),m=(a,l)=>{throw process.exitCode=a,l}}else if(c){if(typeof process=="object"&&process.versions?.node&&process.type!="renderer"||typeof window=="object"||typeof WorkerGlobalScope<"u")throw new Error("not compiled for this environment (did you build to HTML and try to run it not on the web, or set ENVIRONMENT to something - like node - and run it someplace else - like on the web?)")}else if(n||s){try{g=new URL(".",y).href}catch{}if(!(typeof window=="object"||typeof WorkerGlobalScope<"u"))throw new Error("not compiled for this environment (did you build to HTML and try to run it not on the web, or set ENVIRONMENT to something - like node - and run it someplace else - like on the web?)");s&&(C=r=>{var a=new XMLHttpRequest;return a.open("GET",r,!1),a.responseType="arraybuffer",a.send(null),new Uint8Array(a.response)}),E=async r=>{if(ne(r))return new Promise((l,h)=>{var p=new XMLHttpRequest;p.open("GET",r,!0),p.responseType="arraybuffer",p.onload=()=>{if(p.status==200||p.status==0&&p.response){l(p.response);return}h(p.status)},p.onerror=h,p.send(null)});var a=await fetch(r,{credentials:"same-origin"});if(a.ok)return a.arrayBuffer();throw new Error(a.status+" : "+a.url)}}else throw new Error("environment detection error");var O=console.log.bind(console),I=console.error.bind(console),U="IDBFS is no longer included by default; build with -lidbfs.js",N="PROXYFS is no longer included by default; build with -lproxyfs.js",b="WORKERFS is no longer included by default; build with -lworkerfs.js",D="FETCHFS is no longer included by default; build with -lfetchfs.js",q="ICASEFS is no longer included by default; build with -licasefs.js",k="JSFILEFS is no longer included by default; build with -ljsfilefs.js",Y="OPFS is no longer included by default; build with -lopfs.js",J="NODEFS is no longer included by default; build with -lnodefs.js";G(!c,"shell environment detected but not enabled at build time.  Add `shell` to `-sENVIRONMENT` to enable.");var ee;typeof WebAssembly!="object"&&I("no native wasm support detected");var z=!1,ie;function G(r,a){r||pe("Assertion failed"+(a?": "+a:""))}var ne=r=>r.startsWith("file://");function Se(){var r=bl();G((r&3)==0),r==0&&(r+=4),$e[r>>2]=34821223,$e[r+4>>2]=2310721022,$e[0]=1668509029}function re(){if(!z){var r=bl();r==0&&(r+=4);var a=$e[r>>2],l=$e[r+4>>2];(a!=34821223||l!=2310721022)&&pe(`Stack overflow! Stack cookie has been overwritten at ${Ut(r)}, expected hex dwords 0x89BACDFE and 0x2135467, but received ${Ut(l)} ${Ut(a)}`),$e[0]!=1668509029&&pe("Runtime error: The application has corrupted its heap memory area (address zero)!")}}class H extends Error{}class me extends H{}class We extends H{constructor(a){super(a),this.excPtr=a;let l=Eh(a);this.name=l[0],this.message=l[1]}}var nt=!0;function ue(...r){!nt&&typeof nt<"u"||console.warn(...r)}(()=>{var r=new Int16Array(1),a=new Int8Array(r.buffer);if(r[0]=25459,a[0]!==115||a[1]!==99)throw"Runtime error: expected the system to be little-endian! (Run with -sSUPPORT_BIG_ENDIAN to bypass)"})();function Fe(r){Object.getOwnPropertyDescriptor(t,r)||Object.defineProperty(t,r,{configurable:!0,set(){pe(`Attempt to set \`Module.${r}\` after it has already been processed.  This can happen, for example, when code is injected via '--post-js' rather than '--pre-js'`)}})}function Pe(r){return()=>G(!1,`call to '${r}' via reference taken before Wasm module initialization`)}function Ye(r){Object.getOwnPropertyDescriptor(t,r)&&pe(`\`Module.${r}\` was supplied but \`${r}\` not included in INCOMING_MODULE_JS_API`)}function Ue(r){return r==="FS_createPath"||r==="FS_createDataFile"||r==="FS_createPreloadedFile"||r==="FS_unlink"||r==="addRunDependency"||r==="FS_createLazyFile"||r==="FS_createDevice"||r==="removeRunDependency"}function rt(r,a){typeof globalThis<"u"&&!Object.getOwnPropertyDescriptor(globalThis,r)&&Object.defineProperty(globalThis,r,{configurable:!0,get(){a()}})}function Gt(r,a){rt(r,()=>{jn(`\`${r}\` is not longer defined by emscripten. ${a}`)})}Gt("buffer","Please use HEAP8.buffer or wasmMemory.buffer"),Gt("asm","Please use wasmExports instead");function Ke(r){rt(r,()=>{var a=`\`${r}\` is a library symbol and not included by default; add it to your library.js __deps or to DEFAULT_LIBRARY_FUNCS_TO_INCLUDE on the command line`,l=r;l.startsWith("_")||(l="$"+r),a+=` (e.g. -sDEFAULT_LIBRARY_FUNCS_TO_INCLUDE='${l}')`,Ue(r)&&(a+=". Alternatively, forcing filesystem support (-sFORCE_FILESYSTEM) can export this for you"),jn(a)}),bt(r)}function bt(r){Object.getOwnPropertyDescriptor(t,r)||Object.defineProperty(t,r,{configurable:!0,get(){var a=`'${r}' was not exported. add it to EXPORTED_RUNTIME_METHODS (see the Emscripten FAQ)`;Ue(r)&&(a+=". Alternatively, forcing filesystem support (-sFORCE_FILESYSTEM) can export this for you"),pe(a)}})}var Tt,dt,Vt,ut,Ct,xt,Qt,De,$e,an,en,W,pn,At=!1;function Ft(){var r=Vt.buffer;ut=new Int8Array(r),xt=new Int16Array(r),Ct=new Uint8Array(r),Qt=new Uint16Array(r),De=new Int32Array(r),$e=new Uint32Array(r),an=new Float32Array(r),en=new Float64Array(r),W=new BigInt64Array(r),pn=new BigUint64Array(r)}G(typeof Int32Array<"u"&&typeof Float64Array<"u"&&Int32Array.prototype.subarray!=null&&Int32Array.prototype.set!=null,"JS engine does not provide full typed array support");function Le(){if(t.preRun)for(typeof t.preRun=="function"&&(t.preRun=[t.preRun]);t.preRun.length;)lt(t.preRun.shift());Fe("preRun"),Xe(qe)}function Wt(){G(!At),At=!0,re(),!t.noFSInit&&!M.initialized&&M.init(),st.init(),Zi.__wasm_call_ctors(),M.ignorePermissions=!1}function je(){if(re(),t.postRun)for(typeof t.postRun=="function"&&(t.postRun=[t.postRun]);t.postRun.length;)Ee(t.postRun.shift());Fe("postRun"),Xe(ot)}var Ze=0,L=null,T={},Z=null;function ve(r){Ze++,t.monitorRunDependencies?.(Ze),r?(G(!T[r]),T[r]=1,Z===null&&typeof setInterval<"u"&&(Z=setInterval(()=>{if(z){clearInterval(Z),Z=null;return}var a=!1;for(var l in T)a||(a=!0,I("still waiting on run dependencies:")),I(`dependency: ${l}`);a&&I("(end of list)")},1e4))):I("warning: run dependency added without ID")}function de(r){if(Ze--,t.monitorRunDependencies?.(Ze),r?(G(T[r]),delete T[r]):I("warning: run dependency removed without ID"),Ze==0&&(Z!==null&&(clearInterval(Z),Z=null),L)){var a=L;L=null,a()}}function pe(r){t.onAbort?.(r),r="Aborted("+r+")",I(r),z=!0;var a=new WebAssembly.RuntimeError(r);throw dt?.(a),a}function Me(r,a){return(...l)=>{G(At,`native function \`${r}\` called before runtime initialization`);var h=Zi[r];return G(h,`exported native function \`${r}\` not found`),G(l.length<=a,`native function \`${r}\` called with ${l.length} args but expects ${a}`),h(...l)}}var ae;function le(){return t.locateFile?S("mujoco.wasm"):new URL("mujoco.wasm","file:///x").href}function Re(r){if(r==ae&&ee)return new Uint8Array(ee);if(C)return C(r);throw"both async and sync fetching of the wasm failed"}async function B(r){if(!ee)try{var a=await E(r);return new Uint8Array(a)}catch{}return Re(r)}async function he(r,a){try{var l=await B(r),h=await WebAssembly.instantiate(l,a);return h}catch(p){I(`failed to asynchronously prepare wasm: ${p}`),ne(ae)&&I(`warning: Loading from a file URI (${ae}) is not supported in most browsers. See https://emscripten.org/docs/getting_started/FAQ.html#how-do-i-run-a-local-webserver-for-testing-why-does-my-program-stall-in-downloading-or-preparing`),pe(p)}}async function se(r,a,l){if(!r&&typeof WebAssembly.instantiateStreaming=="function"&&!ne(a)&&!o)try{var h=fetch(a,{credentials:"same-origin"}),p=await WebAssembly.instantiateStreaming(h,l);return p}catch(_){I(`wasm streaming compile failed: ${_}`),I("falling back to ArrayBuffer instantiation")}return he(a,l)}function Ce(){return{env:Uh,wasi_snapshot_preview1:Uh}}async function we(){function r(w,A){return Zi=w.exports,Vt=Zi.memory,G(Vt,"memory not found in wasm exports"),Ft(),ra=Zi.__indirect_function_table,G(ra,"table not found in wasm exports"),Qp(Zi),de("wasm-instantiate"),Zi}ve("wasm-instantiate");var a=t;function l(w){return G(t===a,"the Module object should not be replaced during async compilation - perhaps the order of HTML elements is wrong?"),a=null,r(w.instance)}var h=Ce();if(t.instantiateWasm)return new Promise((w,A)=>{try{t.instantiateWasm(h,(F,X)=>{w(r(F,X))})}catch(F){I(`Module.instantiateWasm callback failed with error: ${F}`),A(F)}});ae??=le();var p=await se(ee,ae,h),_=l(p);return _}class Ae{name="ExitStatus";constructor(a){this.message=`Program terminated with exit(${a})`,this.status=a}}var Xe=r=>{for(;r.length>0;)r.shift()(t)},ot=[],Ee=r=>ot.push(r),qe=[],lt=r=>qe.push(r);function Oe(r,a="i8"){switch(a.endsWith("*")&&(a="*"),a){case"i1":return ut[r];case"i8":return ut[r];case"i16":return xt[r>>1];case"i32":return De[r>>2];case"i64":return W[r>>3];case"float":return an[r>>2];case"double":return en[r>>3];case"*":return $e[r>>2];default:pe(`invalid type for getValue: ${a}`)}}var Et=!0,Ut=r=>(G(typeof r=="number"),r>>>=0,"0x"+r.toString(16).padStart(8,"0"));function di(r,a,l="i8"){switch(l.endsWith("*")&&(l="*"),l){case"i1":ut[r]=a;break;case"i8":ut[r]=a;break;case"i16":xt[r>>1]=a;break;case"i32":De[r>>2]=a;break;case"i64":W[r>>3]=BigInt(a);break;case"float":an[r>>2]=a;break;case"double":en[r>>3]=a;break;case"*":$e[r>>2]=a;break;default:pe(`invalid type for setValue: ${l}`)}}var ye=r=>Ph(r),ge=()=>Dh(),jn=r=>{jn.shown||={},jn.shown[r]||(jn.shown[r]=1,o&&(r="warning: "+r),I(r))},qr=typeof TextDecoder<"u"?new TextDecoder:void 0,fi=(r,a=0,l=NaN)=>{for(var h=a+l,p=a;r[p]&&!(p>=h);)++p;if(p-a>16&&r.buffer&&qr)return qr.decode(r.subarray(a,p));for(var _="";a<p;){var w=r[a++];if(!(w&128)){_+=String.fromCharCode(w);continue}var A=r[a++]&63;if((w&224)==192){_+=String.fromCharCode((w&31)<<6|A);continue}var F=r[a++]&63;if((w&240)==224?w=(w&15)<<12|A<<6|F:((w&248)!=240&&jn("Invalid UTF-8 leading byte "+Ut(w)+" encountered when deserializing a UTF-8 string in wasm memory to a JS string!"),w=(w&7)<<18|A<<12|F<<6|r[a++]&63),w<65536)_+=String.fromCharCode(w);else{var X=w-65536;_+=String.fromCharCode(55296|X>>10,56320|X&1023)}}return _},on=(r,a)=>(G(typeof r=="number",`UTF8ToString expects a number (got ${typeof r})`),r?fi(Ct,r,a):""),Yr=(r,a,l,h)=>pe(`Assertion failed: ${on(r)}, at: `+[a?on(a):"unknown filename",l,h?on(h):"unknown function"]),In=[],Hi=0,lr=r=>{var a=new cr(r);return a.get_caught()||(a.set_caught(!0),Hi--),a.set_rethrown(!1),In.push(a),ua(r),Nh(r)},qs=()=>{if(!In.length)return 0;var r=In[In.length-1];return ua(r.excPtr),r.excPtr},Dn=0,Wi=()=>{xe(0,0),G(In.length>0);var r=In.pop();El(r.excPtr),Dn=0};class cr{constructor(a){this.excPtr=a,this.ptr=a-24}set_type(a){$e[this.ptr+4>>2]=a}get_type(){return $e[this.ptr+4>>2]}set_destructor(a){$e[this.ptr+8>>2]=a}get_destructor(){return $e[this.ptr+8>>2]}set_caught(a){a=a?1:0,ut[this.ptr+12]=a}get_caught(){return ut[this.ptr+12]!=0}set_rethrown(a){a=a?1:0,ut[this.ptr+13]=a}get_rethrown(){return ut[this.ptr+13]!=0}init(a,l){this.set_adjusted_ptr(0),this.set_type(a),this.set_destructor(l)}set_adjusted_ptr(a){$e[this.ptr+16>>2]=a}get_adjusted_ptr(){return $e[this.ptr+16>>2]}}var Xi=r=>Rh(r),hr=r=>{var a=Dn?.excPtr;if(!a)return Xi(0),0;var l=new cr(a);l.set_adjusted_ptr(a);var h=l.get_type();if(!h)return Xi(0),a;for(var p of r){if(p===0||p===h)break;var _=l.ptr+16;if(Fh(p,h,_))return Xi(p),a}return Xi(h),a},ll=()=>hr([]),cl=r=>hr([r]),hl=(r,a)=>hr([r,a]),jr=()=>{var r=In.pop();r||pe("no exception to throw");var a=r.excPtr;throw r.get_rethrown()||(In.push(r),r.set_rethrown(!0),r.set_caught(!1),Hi++),Dn=new We(a),Dn},R=r=>{if(r){var a=new cr(r);In.push(a),a.set_rethrown(!0),jr()}},V=(r,a,l)=>{var h=new cr(r);throw h.init(a,l),Dn=new We(r),Hi++,Dn},te=()=>Hi,K=r=>{throw Dn||(Dn=new We(r)),Dn},$={isAbs:r=>r.charAt(0)==="/",splitPath:r=>{var a=/^(\/?|)([\s\S]*?)((?:\.{1,2}|[^\/]+?|)(\.[^.\/]*|))(?:[\/]*)$/;return a.exec(r).slice(1)},normalizeArray:(r,a)=>{for(var l=0,h=r.length-1;h>=0;h--){var p=r[h];p==="."?r.splice(h,1):p===".."?(r.splice(h,1),l++):l&&(r.splice(h,1),l--)}if(a)for(;l;l--)r.unshift("..");return r},normalize:r=>{var a=$.isAbs(r),l=r.slice(-1)==="/";return r=$.normalizeArray(r.split("/").filter(h=>!!h),!a).join("/"),!r&&!a&&(r="."),r&&l&&(r+="/"),(a?"/":"")+r},dirname:r=>{var a=$.splitPath(r),l=a[0],h=a[1];return!l&&!h?".":(h&&(h=h.slice(0,-1)),l+h)},basename:r=>r&&r.match(/([^\/]+|\/)\/*$/)[1],join:(...r)=>$.normalize(r.join("/")),join2:(r,a)=>$.normalize(r+"/"+a)},Ie=()=>{if(o){var r=u("crypto");return a=>r.randomFillSync(a)}return a=>crypto.getRandomValues(a)},ze=r=>{(ze=Ie())(r)},Te={resolve:(...r)=>{for(var a="",l=!1,h=r.length-1;h>=-1&&!l;h--){var p=h>=0?r[h]:M.cwd();if(typeof p!="string")throw new TypeError("Arguments to path.resolve must be strings");if(!p)return"";a=p+"/"+a,l=$.isAbs(p)}return a=$.normalizeArray(a.split("/").filter(_=>!!_),!l).join("/"),(l?"/":"")+a||"."},relative:(r,a)=>{r=Te.resolve(r).slice(1),a=Te.resolve(a).slice(1);function l(X){for(var Q=0;Q<X.length&&X[Q]==="";Q++);for(var oe=X.length-1;oe>=0&&X[oe]==="";oe--);return Q>oe?[]:X.slice(Q,oe-Q+1)}for(var h=l(r.split("/")),p=l(a.split("/")),_=Math.min(h.length,p.length),w=_,A=0;A<_;A++)if(h[A]!==p[A]){w=A;break}for(var F=[],A=w;A<h.length;A++)F.push("..");return F=F.concat(p.slice(w)),F.join("/")}},Ne=[],Ge=r=>{for(var a=0,l=0;l<r.length;++l){var h=r.charCodeAt(l);h<=127?a++:h<=2047?a+=2:h>=55296&&h<=57343?(a+=4,++l):a+=3}return a},it=(r,a,l,h)=>{if(G(typeof r=="string",`stringToUTF8Array expects a string (got ${typeof r})`),!(h>0))return 0;for(var p=l,_=l+h-1,w=0;w<r.length;++w){var A=r.codePointAt(w);if(A<=127){if(l>=_)break;a[l++]=A}else if(A<=2047){if(l+1>=_)break;a[l++]=192|A>>6,a[l++]=128|A&63}else if(A<=65535){if(l+2>=_)break;a[l++]=224|A>>12,a[l++]=128|A>>6&63,a[l++]=128|A&63}else{if(l+3>=_)break;A>1114111&&jn("Invalid Unicode code point "+Ut(A)+" encountered when serializing a JS string to a UTF-8 string in wasm memory! (Valid unicode code points should be in range 0-0x10FFFF)."),a[l++]=240|A>>18,a[l++]=128|A>>12&63,a[l++]=128|A>>6&63,a[l++]=128|A&63,w++}}return a[l]=0,l-p},ft=(r,a,l)=>{var h=l>0?l:Ge(r)+1,p=new Array(h),_=it(r,p,0,p.length);return a&&(p.length=_),p},Ve=()=>{if(!Ne.length){var r=null;if(o){var a=256,l=Buffer.alloc(a),h=0,p=process.stdin.fd;try{h=P.readSync(p,l,0,a)}catch(_){if(_.toString().includes("EOF"))h=0;else throw _}h>0&&(r=l.slice(0,h).toString("utf-8"))}else typeof window<"u"&&typeof window.prompt=="function"&&(r=window.prompt("Input: "),r!==null&&(r+=`
`));if(!r)return null;Ne=ft(r,!0)}return Ne.shift()},st={ttys:[],init(){},shutdown(){},register(r,a){st.ttys[r]={input:[],output:[],ops:a},M.registerDevice(r,st.stream_ops)},stream_ops:{open(r){var a=st.ttys[r.node.rdev];if(!a)throw new M.ErrnoError(43);r.tty=a,r.seekable=!1},close(r){r.tty.ops.fsync(r.tty)},fsync(r){r.tty.ops.fsync(r.tty)},read(r,a,l,h,p){if(!r.tty||!r.tty.ops.get_char)throw new M.ErrnoError(60);for(var _=0,w=0;w<h;w++){var A;try{A=r.tty.ops.get_char(r.tty)}catch{throw new M.ErrnoError(29)}if(A===void 0&&_===0)throw new M.ErrnoError(6);if(A==null)break;_++,a[l+w]=A}return _&&(r.node.atime=Date.now()),_},write(r,a,l,h,p){if(!r.tty||!r.tty.ops.put_char)throw new M.ErrnoError(60);try{for(var _=0;_<h;_++)r.tty.ops.put_char(r.tty,a[l+_])}catch{throw new M.ErrnoError(29)}return h&&(r.node.mtime=r.node.ctime=Date.now()),_}},default_tty_ops:{get_char(r){return Ve()},put_char(r,a){a===null||a===10?(O(fi(r.output)),r.output=[]):a!=0&&r.output.push(a)},fsync(r){r.output?.length>0&&(O(fi(r.output)),r.output=[])},ioctl_tcgets(r){return{c_iflag:25856,c_oflag:5,c_cflag:191,c_lflag:35387,c_cc:[3,28,127,21,4,0,1,0,17,19,26,0,18,15,23,22,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}},ioctl_tcsets(r,a,l){return 0},ioctl_tiocgwinsz(r){return[24,80]}},default_tty1_ops:{put_char(r,a){a===null||a===10?(I(fi(r.output)),r.output=[]):a!=0&&r.output.push(a)},fsync(r){r.output?.length>0&&(I(fi(r.output)),r.output=[])}}},Ht=r=>{pe("internal error: mmapAlloc called but `emscripten_builtin_memalign` native symbol not exported")},ke={ops_table:null,mount(r){return ke.createNode(null,"/",16895,0)},createNode(r,a,l,h){if(M.isBlkdev(l)||M.isFIFO(l))throw new M.ErrnoError(63);ke.ops_table||={dir:{node:{getattr:ke.node_ops.getattr,setattr:ke.node_ops.setattr,lookup:ke.node_ops.lookup,mknod:ke.node_ops.mknod,rename:ke.node_ops.rename,unlink:ke.node_ops.unlink,rmdir:ke.node_ops.rmdir,readdir:ke.node_ops.readdir,symlink:ke.node_ops.symlink},stream:{llseek:ke.stream_ops.llseek}},file:{node:{getattr:ke.node_ops.getattr,setattr:ke.node_ops.setattr},stream:{llseek:ke.stream_ops.llseek,read:ke.stream_ops.read,write:ke.stream_ops.write,mmap:ke.stream_ops.mmap,msync:ke.stream_ops.msync}},link:{node:{getattr:ke.node_ops.getattr,setattr:ke.node_ops.setattr,readlink:ke.node_ops.readlink},stream:{}},chrdev:{node:{getattr:ke.node_ops.getattr,setattr:ke.node_ops.setattr},stream:M.chrdev_stream_ops}};var p=M.createNode(r,a,l,h);return M.isDir(p.mode)?(p.node_ops=ke.ops_table.dir.node,p.stream_ops=ke.ops_table.dir.stream,p.contents={}):M.isFile(p.mode)?(p.node_ops=ke.ops_table.file.node,p.stream_ops=ke.ops_table.file.stream,p.usedBytes=0,p.contents=null):M.isLink(p.mode)?(p.node_ops=ke.ops_table.link.node,p.stream_ops=ke.ops_table.link.stream):M.isChrdev(p.mode)&&(p.node_ops=ke.ops_table.chrdev.node,p.stream_ops=ke.ops_table.chrdev.stream),p.atime=p.mtime=p.ctime=Date.now(),r&&(r.contents[a]=p,r.atime=r.mtime=r.ctime=p.atime),p},getFileDataAsTypedArray(r){return r.contents?r.contents.subarray?r.contents.subarray(0,r.usedBytes):new Uint8Array(r.contents):new Uint8Array(0)},expandFileStorage(r,a){var l=r.contents?r.contents.length:0;if(!(l>=a)){var h=1024*1024;a=Math.max(a,l*(l<h?2:1.125)>>>0),l!=0&&(a=Math.max(a,256));var p=r.contents;r.contents=new Uint8Array(a),r.usedBytes>0&&r.contents.set(p.subarray(0,r.usedBytes),0)}},resizeFileStorage(r,a){if(r.usedBytes!=a)if(a==0)r.contents=null,r.usedBytes=0;else{var l=r.contents;r.contents=new Uint8Array(a),l&&r.contents.set(l.subarray(0,Math.min(a,r.usedBytes))),r.usedBytes=a}},node_ops:{getattr(r){var a={};return a.dev=M.isChrdev(r.mode)?r.id:1,a.ino=r.id,a.mode=r.mode,a.nlink=1,a.uid=0,a.gid=0,a.rdev=r.rdev,M.isDir(r.mode)?a.size=4096:M.isFile(r.mode)?a.size=r.usedBytes:M.isLink(r.mode)?a.size=r.link.length:a.size=0,a.atime=new Date(r.atime),a.mtime=new Date(r.mtime),a.ctime=new Date(r.ctime),a.blksize=4096,a.blocks=Math.ceil(a.size/a.blksize),a},setattr(r,a){for(let l of["mode","atime","mtime","ctime"])a[l]!=null&&(r[l]=a[l]);a.size!==void 0&&ke.resizeFileStorage(r,a.size)},lookup(r,a){throw new M.ErrnoError(44)},mknod(r,a,l,h){return ke.createNode(r,a,l,h)},rename(r,a,l){var h;try{h=M.lookupNode(a,l)}catch{}if(h){if(M.isDir(r.mode))for(var p in h.contents)throw new M.ErrnoError(55);M.hashRemoveNode(h)}delete r.parent.contents[r.name],a.contents[l]=r,r.name=l,a.ctime=a.mtime=r.parent.ctime=r.parent.mtime=Date.now()},unlink(r,a){delete r.contents[a],r.ctime=r.mtime=Date.now()},rmdir(r,a){var l=M.lookupNode(r,a);for(var h in l.contents)throw new M.ErrnoError(55);delete r.contents[a],r.ctime=r.mtime=Date.now()},readdir(r){return[".","..",...Object.keys(r.contents)]},symlink(r,a,l){var h=ke.createNode(r,a,41471,0);return h.link=l,h},readlink(r){if(!M.isLink(r.mode))throw new M.ErrnoError(28);return r.link}},stream_ops:{read(r,a,l,h,p){var _=r.node.contents;if(p>=r.node.usedBytes)return 0;var w=Math.min(r.node.usedBytes-p,h);if(G(w>=0),w>8&&_.subarray)a.set(_.subarray(p,p+w),l);else for(var A=0;A<w;A++)a[l+A]=_[p+A];return w},write(r,a,l,h,p,_){if(G(!(a instanceof ArrayBuffer)),a.buffer===ut.buffer&&(_=!1),!h)return 0;var w=r.node;if(w.mtime=w.ctime=Date.now(),a.subarray&&(!w.contents||w.contents.subarray)){if(_)return G(p===0,"canOwn must imply no weird position inside the file"),w.contents=a.subarray(l,l+h),w.usedBytes=h,h;if(w.usedBytes===0&&p===0)return w.contents=a.slice(l,l+h),w.usedBytes=h,h;if(p+h<=w.usedBytes)return w.contents.set(a.subarray(l,l+h),p),h}if(ke.expandFileStorage(w,p+h),w.contents.subarray&&a.subarray)w.contents.set(a.subarray(l,l+h),p);else for(var A=0;A<h;A++)w.contents[p+A]=a[l+A];return w.usedBytes=Math.max(w.usedBytes,p+h),h},llseek(r,a,l){var h=a;if(l===1?h+=r.position:l===2&&M.isFile(r.node.mode)&&(h+=r.node.usedBytes),h<0)throw new M.ErrnoError(28);return h},mmap(r,a,l,h,p){if(!M.isFile(r.node.mode))throw new M.ErrnoError(43);var _,w,A=r.node.contents;if(!(p&2)&&A&&A.buffer===ut.buffer)w=!1,_=A.byteOffset;else{if(w=!0,_=Ht(a),!_)throw new M.ErrnoError(48);A&&((l>0||l+a<A.length)&&(A.subarray?A=A.subarray(l,l+a):A=Array.prototype.slice.call(A,l,l+a)),ut.set(A,_))}return{ptr:_,allocated:w}},msync(r,a,l,h,p){return ke.stream_ops.write(r,a,0,h,l,!1),0}}},Pt=async r=>{var a=await E(r);return G(a,`Loading data file "${r}" failed (no arrayBuffer).`),new Uint8Array(a)},$t=(...r)=>M.createDataFile(...r),He=r=>{for(var a=r;;){if(!T[r])return r;r=a+Math.random()}},tn=[],St=(r,a,l,h)=>{typeof Browser<"u"&&Browser.init();var p=!1;return tn.forEach(_=>{p||_.canHandle(a)&&(_.handle(r,a,l,h),p=!0)}),p},Zn=(r,a,l,h,p,_,w,A,F,X)=>{var Q=a?Te.resolve($.join2(r,a)):r,oe=He(`cp ${Q}`);function fe(ce){function _e(Je){X?.(),A||$t(r,a,Je,h,p,F),_?.(),de(oe)}St(ce,Q,_e,()=>{w?.(),de(oe)})||_e(ce)}ve(oe),typeof l=="string"?Pt(l).then(fe,w):fe(l)},nn=r=>{var a={r:0,"r+":2,w:577,"w+":578,a:1089,"a+":1090},l=a[r];if(typeof l>"u")throw new Error(`Unknown file open mode: ${r}`);return l},wi=(r,a)=>{var l=0;return r&&(l|=365),a&&(l|=146),l},Jn=r=>on(Ah(r)),Kn={EPERM:63,ENOENT:44,ESRCH:71,EINTR:27,EIO:29,ENXIO:60,E2BIG:1,ENOEXEC:45,EBADF:8,ECHILD:12,EAGAIN:6,EWOULDBLOCK:6,ENOMEM:48,EACCES:2,EFAULT:21,ENOTBLK:105,EBUSY:10,EEXIST:20,EXDEV:75,ENODEV:43,ENOTDIR:54,EISDIR:31,EINVAL:28,ENFILE:41,EMFILE:33,ENOTTY:59,ETXTBSY:74,EFBIG:22,ENOSPC:51,ESPIPE:70,EROFS:69,EMLINK:34,EPIPE:64,EDOM:18,ERANGE:68,ENOMSG:49,EIDRM:24,ECHRNG:106,EL2NSYNC:156,EL3HLT:107,EL3RST:108,ELNRNG:109,EUNATCH:110,ENOCSI:111,EL2HLT:112,EDEADLK:16,ENOLCK:46,EBADE:113,EBADR:114,EXFULL:115,ENOANO:104,EBADRQC:103,EBADSLT:102,EDEADLOCK:16,EBFONT:101,ENOSTR:100,ENODATA:116,ETIME:117,ENOSR:118,ENONET:119,ENOPKG:120,EREMOTE:121,ENOLINK:47,EADV:122,ESRMNT:123,ECOMM:124,EPROTO:65,EMULTIHOP:36,EDOTDOT:125,EBADMSG:9,ENOTUNIQ:126,EBADFD:127,EREMCHG:128,ELIBACC:129,ELIBBAD:130,ELIBSCN:131,ELIBMAX:132,ELIBEXEC:133,ENOSYS:52,ENOTEMPTY:55,ENAMETOOLONG:37,ELOOP:32,EOPNOTSUPP:138,EPFNOSUPPORT:139,ECONNRESET:15,ENOBUFS:42,EAFNOSUPPORT:5,EPROTOTYPE:67,ENOTSOCK:57,ENOPROTOOPT:50,ESHUTDOWN:140,ECONNREFUSED:14,EADDRINUSE:3,ECONNABORTED:13,ENETUNREACH:40,ENETDOWN:38,ETIMEDOUT:73,EHOSTDOWN:142,EHOSTUNREACH:23,EINPROGRESS:26,EALREADY:7,EDESTADDRREQ:17,EMSGSIZE:35,EPROTONOSUPPORT:66,ESOCKTNOSUPPORT:137,EADDRNOTAVAIL:4,ENETRESET:39,EISCONN:30,ENOTCONN:53,ETOOMANYREFS:141,EUSERS:136,EDQUOT:19,ESTALE:72,ENOTSUP:138,ENOMEDIUM:148,EILSEQ:25,EOVERFLOW:61,ECANCELED:11,ENOTRECOVERABLE:56,EOWNERDEAD:62,ESTRPIPE:135},M={root:null,mounts:[],devices:{},streams:[],nextInode:1,nameTable:null,currentPath:"/",initialized:!1,ignorePermissions:!0,filesystems:null,syncFSRequests:0,readFiles:{},ErrnoError:class extends Error{name="ErrnoError";constructor(r){super(At?Jn(r):""),this.errno=r;for(var a in Kn)if(Kn[a]===r){this.code=a;break}}},FSStream:class{shared={};get object(){return this.node}set object(r){this.node=r}get isRead(){return(this.flags&2097155)!==1}get isWrite(){return(this.flags&2097155)!==0}get isAppend(){return this.flags&1024}get flags(){return this.shared.flags}set flags(r){this.shared.flags=r}get position(){return this.shared.position}set position(r){this.shared.position=r}},FSNode:class{node_ops={};stream_ops={};readMode=365;writeMode=146;mounted=null;constructor(r,a,l,h){r||(r=this),this.parent=r,this.mount=r.mount,this.id=M.nextInode++,this.name=a,this.mode=l,this.rdev=h,this.atime=this.mtime=this.ctime=Date.now()}get read(){return(this.mode&this.readMode)===this.readMode}set read(r){r?this.mode|=this.readMode:this.mode&=~this.readMode}get write(){return(this.mode&this.writeMode)===this.writeMode}set write(r){r?this.mode|=this.writeMode:this.mode&=~this.writeMode}get isFolder(){return M.isDir(this.mode)}get isDevice(){return M.isChrdev(this.mode)}},lookupPath(r,a={}){if(!r)throw new M.ErrnoError(44);a.follow_mount??=!0,$.isAbs(r)||(r=M.cwd()+"/"+r);e:for(var l=0;l<40;l++){for(var h=r.split("/").filter(X=>!!X),p=M.root,_="/",w=0;w<h.length;w++){var A=w===h.length-1;if(A&&a.parent)break;if(h[w]!=="."){if(h[w]===".."){if(_=$.dirname(_),M.isRoot(p)){r=_+"/"+h.slice(w+1).join("/");continue e}else p=p.parent;continue}_=$.join2(_,h[w]);try{p=M.lookupNode(p,h[w])}catch(X){if(X?.errno===44&&A&&a.noent_okay)return{path:_};throw X}if(M.isMountpoint(p)&&(!A||a.follow_mount)&&(p=p.mounted.root),M.isLink(p.mode)&&(!A||a.follow)){if(!p.node_ops.readlink)throw new M.ErrnoError(52);var F=p.node_ops.readlink(p);$.isAbs(F)||(F=$.dirname(_)+"/"+F),r=F+"/"+h.slice(w+1).join("/");continue e}}}return{path:_,node:p}}throw new M.ErrnoError(32)},getPath(r){for(var a;;){if(M.isRoot(r)){var l=r.mount.mountpoint;return a?l[l.length-1]!=="/"?`${l}/${a}`:l+a:l}a=a?`${r.name}/${a}`:r.name,r=r.parent}},hashName(r,a){for(var l=0,h=0;h<a.length;h++)l=(l<<5)-l+a.charCodeAt(h)|0;return(r+l>>>0)%M.nameTable.length},hashAddNode(r){var a=M.hashName(r.parent.id,r.name);r.name_next=M.nameTable[a],M.nameTable[a]=r},hashRemoveNode(r){var a=M.hashName(r.parent.id,r.name);if(M.nameTable[a]===r)M.nameTable[a]=r.name_next;else for(var l=M.nameTable[a];l;){if(l.name_next===r){l.name_next=r.name_next;break}l=l.name_next}},lookupNode(r,a){var l=M.mayLookup(r);if(l)throw new M.ErrnoError(l);for(var h=M.hashName(r.id,a),p=M.nameTable[h];p;p=p.name_next){var _=p.name;if(p.parent.id===r.id&&_===a)return p}return M.lookup(r,a)},createNode(r,a,l,h){G(typeof r=="object");var p=new M.FSNode(r,a,l,h);return M.hashAddNode(p),p},destroyNode(r){M.hashRemoveNode(r)},isRoot(r){return r===r.parent},isMountpoint(r){return!!r.mounted},isFile(r){return(r&61440)===32768},isDir(r){return(r&61440)===16384},isLink(r){return(r&61440)===40960},isChrdev(r){return(r&61440)===8192},isBlkdev(r){return(r&61440)===24576},isFIFO(r){return(r&61440)===4096},isSocket(r){return(r&49152)===49152},flagsToPermissionString(r){var a=["r","w","rw"][r&3];return r&512&&(a+="w"),a},nodePermissions(r,a){return M.ignorePermissions?0:a.includes("r")&&!(r.mode&292)||a.includes("w")&&!(r.mode&146)||a.includes("x")&&!(r.mode&73)?2:0},mayLookup(r){if(!M.isDir(r.mode))return 54;var a=M.nodePermissions(r,"x");return a||(r.node_ops.lookup?0:2)},mayCreate(r,a){if(!M.isDir(r.mode))return 54;try{var l=M.lookupNode(r,a);return 20}catch{}return M.nodePermissions(r,"wx")},mayDelete(r,a,l){var h;try{h=M.lookupNode(r,a)}catch(_){return _.errno}var p=M.nodePermissions(r,"wx");if(p)return p;if(l){if(!M.isDir(h.mode))return 54;if(M.isRoot(h)||M.getPath(h)===M.cwd())return 10}else if(M.isDir(h.mode))return 31;return 0},mayOpen(r,a){return r?M.isLink(r.mode)?32:M.isDir(r.mode)&&(M.flagsToPermissionString(a)!=="r"||a&576)?31:M.nodePermissions(r,M.flagsToPermissionString(a)):44},checkOpExists(r,a){if(!r)throw new M.ErrnoError(a);return r},MAX_OPEN_FDS:4096,nextfd(){for(var r=0;r<=M.MAX_OPEN_FDS;r++)if(!M.streams[r])return r;throw new M.ErrnoError(33)},getStreamChecked(r){var a=M.getStream(r);if(!a)throw new M.ErrnoError(8);return a},getStream:r=>M.streams[r],createStream(r,a=-1){return G(a>=-1),r=Object.assign(new M.FSStream,r),a==-1&&(a=M.nextfd()),r.fd=a,M.streams[a]=r,r},closeStream(r){M.streams[r]=null},dupStream(r,a=-1){var l=M.createStream(r,a);return l.stream_ops?.dup?.(l),l},doSetAttr(r,a,l){var h=r?.stream_ops.setattr,p=h?r:a;h??=a.node_ops.setattr,M.checkOpExists(h,63),h(p,l)},chrdev_stream_ops:{open(r){var a=M.getDevice(r.node.rdev);r.stream_ops=a.stream_ops,r.stream_ops.open?.(r)},llseek(){throw new M.ErrnoError(70)}},major:r=>r>>8,minor:r=>r&255,makedev:(r,a)=>r<<8|a,registerDevice(r,a){M.devices[r]={stream_ops:a}},getDevice:r=>M.devices[r],getMounts(r){for(var a=[],l=[r];l.length;){var h=l.pop();a.push(h),l.push(...h.mounts)}return a},syncfs(r,a){typeof r=="function"&&(a=r,r=!1),M.syncFSRequests++,M.syncFSRequests>1&&I(`warning: ${M.syncFSRequests} FS.syncfs operations in flight at once, probably just doing extra work`);var l=M.getMounts(M.root.mount),h=0;function p(w){return G(M.syncFSRequests>0),M.syncFSRequests--,a(w)}function _(w){if(w)return _.errored?void 0:(_.errored=!0,p(w));++h>=l.length&&p(null)}l.forEach(w=>{if(!w.type.syncfs)return _(null);w.type.syncfs(w,r,_)})},mount(r,a,l){if(typeof r=="string")throw r;var h=l==="/",p=!l,_;if(h&&M.root)throw new M.ErrnoError(10);if(!h&&!p){var w=M.lookupPath(l,{follow_mount:!1});if(l=w.path,_=w.node,M.isMountpoint(_))throw new M.ErrnoError(10);if(!M.isDir(_.mode))throw new M.ErrnoError(54)}var A={type:r,opts:a,mountpoint:l,mounts:[]},F=r.mount(A);return F.mount=A,A.root=F,h?M.root=F:_&&(_.mounted=A,_.mount&&_.mount.mounts.push(A)),F},unmount(r){var a=M.lookupPath(r,{follow_mount:!1});if(!M.isMountpoint(a.node))throw new M.ErrnoError(28);var l=a.node,h=l.mounted,p=M.getMounts(h);Object.keys(M.nameTable).forEach(w=>{for(var A=M.nameTable[w];A;){var F=A.name_next;p.includes(A.mount)&&M.destroyNode(A),A=F}}),l.mounted=null;var _=l.mount.mounts.indexOf(h);G(_!==-1),l.mount.mounts.splice(_,1)},lookup(r,a){return r.node_ops.lookup(r,a)},mknod(r,a,l){var h=M.lookupPath(r,{parent:!0}),p=h.node,_=$.basename(r);if(!_)throw new M.ErrnoError(28);if(_==="."||_==="..")throw new M.ErrnoError(20);var w=M.mayCreate(p,_);if(w)throw new M.ErrnoError(w);if(!p.node_ops.mknod)throw new M.ErrnoError(63);return p.node_ops.mknod(p,_,a,l)},statfs(r){return M.statfsNode(M.lookupPath(r,{follow:!0}).node)},statfsStream(r){return M.statfsNode(r.node)},statfsNode(r){var a={bsize:4096,frsize:4096,blocks:1e6,bfree:5e5,bavail:5e5,files:M.nextInode,ffree:M.nextInode-1,fsid:42,flags:2,namelen:255};return r.node_ops.statfs&&Object.assign(a,r.node_ops.statfs(r.mount.opts.root)),a},create(r,a=438){return a&=4095,a|=32768,M.mknod(r,a,0)},mkdir(r,a=511){return a&=1023,a|=16384,M.mknod(r,a,0)},mkdirTree(r,a){var l=r.split("/"),h="";for(var p of l)if(p){(h||$.isAbs(r))&&(h+="/"),h+=p;try{M.mkdir(h,a)}catch(_){if(_.errno!=20)throw _}}},mkdev(r,a,l){return typeof l>"u"&&(l=a,a=438),a|=8192,M.mknod(r,a,l)},symlink(r,a){if(!Te.resolve(r))throw new M.ErrnoError(44);var l=M.lookupPath(a,{parent:!0}),h=l.node;if(!h)throw new M.ErrnoError(44);var p=$.basename(a),_=M.mayCreate(h,p);if(_)throw new M.ErrnoError(_);if(!h.node_ops.symlink)throw new M.ErrnoError(63);return h.node_ops.symlink(h,p,r)},rename(r,a){var l=$.dirname(r),h=$.dirname(a),p=$.basename(r),_=$.basename(a),w,A,F;if(w=M.lookupPath(r,{parent:!0}),A=w.node,w=M.lookupPath(a,{parent:!0}),F=w.node,!A||!F)throw new M.ErrnoError(44);if(A.mount!==F.mount)throw new M.ErrnoError(75);var X=M.lookupNode(A,p),Q=Te.relative(r,h);if(Q.charAt(0)!==".")throw new M.ErrnoError(28);if(Q=Te.relative(a,l),Q.charAt(0)!==".")throw new M.ErrnoError(55);var oe;try{oe=M.lookupNode(F,_)}catch{}if(X!==oe){var fe=M.isDir(X.mode),ce=M.mayDelete(A,p,fe);if(ce)throw new M.ErrnoError(ce);if(ce=oe?M.mayDelete(F,_,fe):M.mayCreate(F,_),ce)throw new M.ErrnoError(ce);if(!A.node_ops.rename)throw new M.ErrnoError(63);if(M.isMountpoint(X)||oe&&M.isMountpoint(oe))throw new M.ErrnoError(10);if(F!==A&&(ce=M.nodePermissions(A,"w"),ce))throw new M.ErrnoError(ce);M.hashRemoveNode(X);try{A.node_ops.rename(X,F,_),X.parent=F}catch(_e){throw _e}finally{M.hashAddNode(X)}}},rmdir(r){var a=M.lookupPath(r,{parent:!0}),l=a.node,h=$.basename(r),p=M.lookupNode(l,h),_=M.mayDelete(l,h,!0);if(_)throw new M.ErrnoError(_);if(!l.node_ops.rmdir)throw new M.ErrnoError(63);if(M.isMountpoint(p))throw new M.ErrnoError(10);l.node_ops.rmdir(l,h),M.destroyNode(p)},readdir(r){var a=M.lookupPath(r,{follow:!0}),l=a.node,h=M.checkOpExists(l.node_ops.readdir,54);return h(l)},unlink(r){var a=M.lookupPath(r,{parent:!0}),l=a.node;if(!l)throw new M.ErrnoError(44);var h=$.basename(r),p=M.lookupNode(l,h),_=M.mayDelete(l,h,!1);if(_)throw new M.ErrnoError(_);if(!l.node_ops.unlink)throw new M.ErrnoError(63);if(M.isMountpoint(p))throw new M.ErrnoError(10);l.node_ops.unlink(l,h),M.destroyNode(p)},readlink(r){var a=M.lookupPath(r),l=a.node;if(!l)throw new M.ErrnoError(44);if(!l.node_ops.readlink)throw new M.ErrnoError(28);return l.node_ops.readlink(l)},stat(r,a){var l=M.lookupPath(r,{follow:!a}),h=l.node,p=M.checkOpExists(h.node_ops.getattr,63);return p(h)},fstat(r){var a=M.getStreamChecked(r),l=a.node,h=a.stream_ops.getattr,p=h?a:l;return h??=l.node_ops.getattr,M.checkOpExists(h,63),h(p)},lstat(r){return M.stat(r,!0)},doChmod(r,a,l,h){M.doSetAttr(r,a,{mode:l&4095|a.mode&-4096,ctime:Date.now(),dontFollow:h})},chmod(r,a,l){var h;if(typeof r=="string"){var p=M.lookupPath(r,{follow:!l});h=p.node}else h=r;M.doChmod(null,h,a,l)},lchmod(r,a){M.chmod(r,a,!0)},fchmod(r,a){var l=M.getStreamChecked(r);M.doChmod(l,l.node,a,!1)},doChown(r,a,l){M.doSetAttr(r,a,{timestamp:Date.now(),dontFollow:l})},chown(r,a,l,h){var p;if(typeof r=="string"){var _=M.lookupPath(r,{follow:!h});p=_.node}else p=r;M.doChown(null,p,h)},lchown(r,a,l){M.chown(r,a,l,!0)},fchown(r,a,l){var h=M.getStreamChecked(r);M.doChown(h,h.node,!1)},doTruncate(r,a,l){if(M.isDir(a.mode))throw new M.ErrnoError(31);if(!M.isFile(a.mode))throw new M.ErrnoError(28);var h=M.nodePermissions(a,"w");if(h)throw new M.ErrnoError(h);M.doSetAttr(r,a,{size:l,timestamp:Date.now()})},truncate(r,a){if(a<0)throw new M.ErrnoError(28);var l;if(typeof r=="string"){var h=M.lookupPath(r,{follow:!0});l=h.node}else l=r;M.doTruncate(null,l,a)},ftruncate(r,a){var l=M.getStreamChecked(r);if(a<0||(l.flags&2097155)===0)throw new M.ErrnoError(28);M.doTruncate(l,l.node,a)},utime(r,a,l){var h=M.lookupPath(r,{follow:!0}),p=h.node,_=M.checkOpExists(p.node_ops.setattr,63);_(p,{atime:a,mtime:l})},open(r,a,l=438){if(r==="")throw new M.ErrnoError(44);a=typeof a=="string"?nn(a):a,a&64?l=l&4095|32768:l=0;var h,p;if(typeof r=="object")h=r;else{p=r.endsWith("/");var _=M.lookupPath(r,{follow:!(a&131072),noent_okay:!0});h=_.node,r=_.path}var w=!1;if(a&64)if(h){if(a&128)throw new M.ErrnoError(20)}else{if(p)throw new M.ErrnoError(31);h=M.mknod(r,l|511,0),w=!0}if(!h)throw new M.ErrnoError(44);if(M.isChrdev(h.mode)&&(a&=-513),a&65536&&!M.isDir(h.mode))throw new M.ErrnoError(54);if(!w){var A=M.mayOpen(h,a);if(A)throw new M.ErrnoError(A)}a&512&&!w&&M.truncate(h,0),a&=-131713;var F=M.createStream({node:h,path:M.getPath(h),flags:a,seekable:!0,position:0,stream_ops:h.stream_ops,ungotten:[],error:!1});return F.stream_ops.open&&F.stream_ops.open(F),w&&M.chmod(h,l&511),t.logReadFiles&&!(a&1)&&(r in M.readFiles||(M.readFiles[r]=1)),F},close(r){if(M.isClosed(r))throw new M.ErrnoError(8);r.getdents&&(r.getdents=null);try{r.stream_ops.close&&r.stream_ops.close(r)}catch(a){throw a}finally{M.closeStream(r.fd)}r.fd=null},isClosed(r){return r.fd===null},llseek(r,a,l){if(M.isClosed(r))throw new M.ErrnoError(8);if(!r.seekable||!r.stream_ops.llseek)throw new M.ErrnoError(70);if(l!=0&&l!=1&&l!=2)throw new M.ErrnoError(28);return r.position=r.stream_ops.llseek(r,a,l),r.ungotten=[],r.position},read(r,a,l,h,p){if(G(l>=0),h<0||p<0)throw new M.ErrnoError(28);if(M.isClosed(r))throw new M.ErrnoError(8);if((r.flags&2097155)===1)throw new M.ErrnoError(8);if(M.isDir(r.node.mode))throw new M.ErrnoError(31);if(!r.stream_ops.read)throw new M.ErrnoError(28);var _=typeof p<"u";if(!_)p=r.position;else if(!r.seekable)throw new M.ErrnoError(70);var w=r.stream_ops.read(r,a,l,h,p);return _||(r.position+=w),w},write(r,a,l,h,p,_){if(G(l>=0),h<0||p<0)throw new M.ErrnoError(28);if(M.isClosed(r))throw new M.ErrnoError(8);if((r.flags&2097155)===0)throw new M.ErrnoError(8);if(M.isDir(r.node.mode))throw new M.ErrnoError(31);if(!r.stream_ops.write)throw new M.ErrnoError(28);r.seekable&&r.flags&1024&&M.llseek(r,0,2);var w=typeof p<"u";if(!w)p=r.position;else if(!r.seekable)throw new M.ErrnoError(70);var A=r.stream_ops.write(r,a,l,h,p,_);return w||(r.position+=A),A},mmap(r,a,l,h,p){if((h&2)!==0&&(p&2)===0&&(r.flags&2097155)!==2)throw new M.ErrnoError(2);if((r.flags&2097155)===1)throw new M.ErrnoError(2);if(!r.stream_ops.mmap)throw new M.ErrnoError(43);if(!a)throw new M.ErrnoError(28);return r.stream_ops.mmap(r,a,l,h,p)},msync(r,a,l,h,p){return G(l>=0),r.stream_ops.msync?r.stream_ops.msync(r,a,l,h,p):0},ioctl(r,a,l){if(!r.stream_ops.ioctl)throw new M.ErrnoError(59);return r.stream_ops.ioctl(r,a,l)},readFile(r,a={}){if(a.flags=a.flags||0,a.encoding=a.encoding||"binary",a.encoding!=="utf8"&&a.encoding!=="binary")throw new Error(`Invalid encoding type "${a.encoding}"`);var l=M.open(r,a.flags),h=M.stat(r),p=h.size,_=new Uint8Array(p);return M.read(l,_,0,p,0),a.encoding==="utf8"&&(_=fi(_)),M.close(l),_},writeFile(r,a,l={}){l.flags=l.flags||577;var h=M.open(r,l.flags,l.mode);if(typeof a=="string"&&(a=new Uint8Array(ft(a,!0))),ArrayBuffer.isView(a))M.write(h,a,0,a.byteLength,void 0,l.canOwn);else throw new Error("Unsupported data type");M.close(h)},cwd:()=>M.currentPath,chdir(r){var a=M.lookupPath(r,{follow:!0});if(a.node===null)throw new M.ErrnoError(44);if(!M.isDir(a.node.mode))throw new M.ErrnoError(54);var l=M.nodePermissions(a.node,"x");if(l)throw new M.ErrnoError(l);M.currentPath=a.path},createDefaultDirectories(){M.mkdir("/tmp"),M.mkdir("/home"),M.mkdir("/home/web_user")},createDefaultDevices(){M.mkdir("/dev"),M.registerDevice(M.makedev(1,3),{read:()=>0,write:(h,p,_,w,A)=>w,llseek:()=>0}),M.mkdev("/dev/null",M.makedev(1,3)),st.register(M.makedev(5,0),st.default_tty_ops),st.register(M.makedev(6,0),st.default_tty1_ops),M.mkdev("/dev/tty",M.makedev(5,0)),M.mkdev("/dev/tty1",M.makedev(6,0));var r=new Uint8Array(1024),a=0,l=()=>(a===0&&(ze(r),a=r.byteLength),r[--a]);M.createDevice("/dev","random",l),M.createDevice("/dev","urandom",l),M.mkdir("/dev/shm"),M.mkdir("/dev/shm/tmp")},createSpecialDirectories(){M.mkdir("/proc");var r=M.mkdir("/proc/self");M.mkdir("/proc/self/fd"),M.mount({mount(){var a=M.createNode(r,"fd",16895,73);return a.stream_ops={llseek:ke.stream_ops.llseek},a.node_ops={lookup(l,h){var p=+h,_=M.getStreamChecked(p),w={parent:null,mount:{mountpoint:"fake"},node_ops:{readlink:()=>_.path},id:p+1};return w.parent=w,w},readdir(){return Array.from(M.streams.entries()).filter(([l,h])=>h).map(([l,h])=>l.toString())}},a}},{},"/proc/self/fd")},createStandardStreams(r,a,l){r?M.createDevice("/dev","stdin",r):M.symlink("/dev/tty","/dev/stdin"),a?M.createDevice("/dev","stdout",null,a):M.symlink("/dev/tty","/dev/stdout"),l?M.createDevice("/dev","stderr",null,l):M.symlink("/dev/tty1","/dev/stderr");var h=M.open("/dev/stdin",0),p=M.open("/dev/stdout",1),_=M.open("/dev/stderr",1);G(h.fd===0,`invalid handle for stdin (${h.fd})`),G(p.fd===1,`invalid handle for stdout (${p.fd})`),G(_.fd===2,`invalid handle for stderr (${_.fd})`)},staticInit(){M.nameTable=new Array(4096),M.mount(ke,{},"/"),M.createDefaultDirectories(),M.createDefaultDevices(),M.createSpecialDirectories(),M.filesystems={MEMFS:ke}},init(r,a,l){G(!M.initialized,"FS.init was previously called. If you want to initialize later with custom parameters, remove any earlier calls (note that one is automatically added to the generated code)"),M.initialized=!0,r??=t.stdin,a??=t.stdout,l??=t.stderr,M.createStandardStreams(r,a,l)},quit(){M.initialized=!1,Ml(0);for(var r of M.streams)r&&M.close(r)},findObject(r,a){var l=M.analyzePath(r,a);return l.exists?l.object:null},analyzePath(r,a){try{var l=M.lookupPath(r,{follow:!a});r=l.path}catch{}var h={isRoot:!1,exists:!1,error:0,name:null,path:null,object:null,parentExists:!1,parentPath:null,parentObject:null};try{var l=M.lookupPath(r,{parent:!0});h.parentExists=!0,h.parentPath=l.path,h.parentObject=l.node,h.name=$.basename(r),l=M.lookupPath(r,{follow:!a}),h.exists=!0,h.path=l.path,h.object=l.node,h.name=l.node.name,h.isRoot=l.path==="/"}catch(p){h.error=p.errno}return h},createPath(r,a,l,h){r=typeof r=="string"?r:M.getPath(r);for(var p=a.split("/").reverse();p.length;){var _=p.pop();if(_){var w=$.join2(r,_);try{M.mkdir(w)}catch(A){if(A.errno!=20)throw A}r=w}}return w},createFile(r,a,l,h,p){var _=$.join2(typeof r=="string"?r:M.getPath(r),a),w=wi(h,p);return M.create(_,w)},createDataFile(r,a,l,h,p,_){var w=a;r&&(r=typeof r=="string"?r:M.getPath(r),w=a?$.join2(r,a):r);var A=wi(h,p),F=M.create(w,A);if(l){if(typeof l=="string"){for(var X=new Array(l.length),Q=0,oe=l.length;Q<oe;++Q)X[Q]=l.charCodeAt(Q);l=X}M.chmod(F,A|146);var fe=M.open(F,577);M.write(fe,l,0,l.length,0,_),M.close(fe),M.chmod(F,A)}},createDevice(r,a,l,h){var p=$.join2(typeof r=="string"?r:M.getPath(r),a),_=wi(!!l,!!h);M.createDevice.major??=64;var w=M.makedev(M.createDevice.major++,0);return M.registerDevice(w,{open(A){A.seekable=!1},close(A){h?.buffer?.length&&h(10)},read(A,F,X,Q,oe){for(var fe=0,ce=0;ce<Q;ce++){var _e;try{_e=l()}catch{throw new M.ErrnoError(29)}if(_e===void 0&&fe===0)throw new M.ErrnoError(6);if(_e==null)break;fe++,F[X+ce]=_e}return fe&&(A.node.atime=Date.now()),fe},write(A,F,X,Q,oe){for(var fe=0;fe<Q;fe++)try{h(F[X+fe])}catch{throw new M.ErrnoError(29)}return Q&&(A.node.mtime=A.node.ctime=Date.now()),fe}}),M.mkdev(p,_,w)},forceLoadFile(r){if(r.isDevice||r.isFolder||r.link||r.contents)return!0;if(typeof XMLHttpRequest<"u")throw new Error("Lazy loading should have been performed (contents set) in createLazyFile, but it was not. Lazy loading only works in web workers. Use --embed-file or --preload-file in emcc on the main thread.");try{r.contents=C(r.url),r.usedBytes=r.contents.length}catch{throw new M.ErrnoError(29)}},createLazyFile(r,a,l,h,p){class _{lengthKnown=!1;chunks=[];get(ce){if(!(ce>this.length-1||ce<0)){var _e=ce%this.chunkSize,Je=ce/this.chunkSize|0;return this.getter(Je)[_e]}}setDataGetter(ce){this.getter=ce}cacheLength(){var ce=new XMLHttpRequest;if(ce.open("HEAD",l,!1),ce.send(null),!(ce.status>=200&&ce.status<300||ce.status===304))throw new Error("Couldn't load "+l+". Status: "+ce.status);var _e=Number(ce.getResponseHeader("Content-length")),Je,vt=(Je=ce.getResponseHeader("Accept-Ranges"))&&Je==="bytes",pt=(Je=ce.getResponseHeader("Content-Encoding"))&&Je==="gzip",Nt=1024*1024;vt||(Nt=_e);var Mt=(jt,mn)=>{if(jt>mn)throw new Error("invalid range ("+jt+", "+mn+") or no bytes requested!");if(mn>_e-1)throw new Error("only "+_e+" bytes available! programmer error!");var Dt=new XMLHttpRequest;if(Dt.open("GET",l,!1),_e!==Nt&&Dt.setRequestHeader("Range","bytes="+jt+"-"+mn),Dt.responseType="arraybuffer",Dt.overrideMimeType&&Dt.overrideMimeType("text/plain; charset=x-user-defined"),Dt.send(null),!(Dt.status>=200&&Dt.status<300||Dt.status===304))throw new Error("Couldn't load "+l+". Status: "+Dt.status);return Dt.response!==void 0?new Uint8Array(Dt.response||[]):ft(Dt.responseText||"",!0)},cn=this;cn.setDataGetter(jt=>{var mn=jt*Nt,Dt=(jt+1)*Nt-1;if(Dt=Math.min(Dt,_e-1),typeof cn.chunks[jt]>"u"&&(cn.chunks[jt]=Mt(mn,Dt)),typeof cn.chunks[jt]>"u")throw new Error("doXHR failed!");return cn.chunks[jt]}),(pt||!_e)&&(Nt=_e=1,_e=this.getter(0).length,Nt=_e,O("LazyFiles on gzip forces download of the whole file when length is accessed")),this._length=_e,this._chunkSize=Nt,this.lengthKnown=!0}get length(){return this.lengthKnown||this.cacheLength(),this._length}get chunkSize(){return this.lengthKnown||this.cacheLength(),this._chunkSize}}if(typeof XMLHttpRequest<"u"){if(!s)throw"Cannot do synchronous binary XHRs outside webworkers in modern browsers. Use --embed-file or --preload-file in emcc";var w=new _,A={isDevice:!1,contents:w}}else var A={isDevice:!1,url:l};var F=M.createFile(r,a,A,h,p);A.contents?F.contents=A.contents:A.url&&(F.contents=null,F.url=A.url),Object.defineProperties(F,{usedBytes:{get:function(){return this.contents.length}}});var X={},Q=Object.keys(F.stream_ops);Q.forEach(fe=>{var ce=F.stream_ops[fe];X[fe]=(..._e)=>(M.forceLoadFile(F),ce(..._e))});function oe(fe,ce,_e,Je,vt){var pt=fe.node.contents;if(vt>=pt.length)return 0;var Nt=Math.min(pt.length-vt,Je);if(G(Nt>=0),pt.slice)for(var Mt=0;Mt<Nt;Mt++)ce[_e+Mt]=pt[vt+Mt];else for(var Mt=0;Mt<Nt;Mt++)ce[_e+Mt]=pt.get(vt+Mt);return Nt}return X.read=(fe,ce,_e,Je,vt)=>(M.forceLoadFile(F),oe(fe,ce,_e,Je,vt)),X.mmap=(fe,ce,_e,Je,vt)=>{M.forceLoadFile(F);var pt=Ht(ce);if(!pt)throw new M.ErrnoError(48);return oe(fe,ut,pt,ce,_e),{ptr:pt,allocated:!0}},F.stream_ops=X,F},absolutePath(){pe("FS.absolutePath has been removed; use PATH_FS.resolve instead")},createFolder(){pe("FS.createFolder has been removed; use FS.mkdir instead")},createLink(){pe("FS.createLink has been removed; use FS.symlink instead")},joinPath(){pe("FS.joinPath has been removed; use PATH.join instead")},mmapAlloc(){pe("FS.mmapAlloc has been replaced by the top level function mmapAlloc")},standardizePath(){pe("FS.standardizePath has been removed; use PATH.normalize instead")}},ht={DEFAULT_POLLMASK:5,calculateAt(r,a,l){if($.isAbs(a))return a;var h;if(r===-100)h=M.cwd();else{var p=ht.getStreamFromFD(r);h=p.path}if(a.length==0){if(!l)throw new M.ErrnoError(44);return h}return h+"/"+a},writeStat(r,a){De[r>>2]=a.dev,De[r+4>>2]=a.mode,$e[r+8>>2]=a.nlink,De[r+12>>2]=a.uid,De[r+16>>2]=a.gid,De[r+20>>2]=a.rdev,W[r+24>>3]=BigInt(a.size),De[r+32>>2]=4096,De[r+36>>2]=a.blocks;var l=a.atime.getTime(),h=a.mtime.getTime(),p=a.ctime.getTime();return W[r+40>>3]=BigInt(Math.floor(l/1e3)),$e[r+48>>2]=l%1e3*1e3*1e3,W[r+56>>3]=BigInt(Math.floor(h/1e3)),$e[r+64>>2]=h%1e3*1e3*1e3,W[r+72>>3]=BigInt(Math.floor(p/1e3)),$e[r+80>>2]=p%1e3*1e3*1e3,W[r+88>>3]=BigInt(a.ino),0},writeStatFs(r,a){De[r+4>>2]=a.bsize,De[r+40>>2]=a.bsize,De[r+8>>2]=a.blocks,De[r+12>>2]=a.bfree,De[r+16>>2]=a.bavail,De[r+20>>2]=a.files,De[r+24>>2]=a.ffree,De[r+28>>2]=a.fsid,De[r+44>>2]=a.flags,De[r+36>>2]=a.namelen},doMsync(r,a,l,h,p){if(!M.isFile(a.node.mode))throw new M.ErrnoError(43);if(h&2)return 0;var _=Ct.slice(r,r+l);M.msync(a,_,p,l,h)},getStreamFromFD(r){var a=M.getStreamChecked(r);return a},varargs:void 0,getStr(r){var a=on(r);return a}};function wn(r,a,l){try{var h=ht.getStreamFromFD(r);if(G(!l),h.fd===a)return-28;if(a<0||a>=M.MAX_OPEN_FDS)return-8;var p=M.getStream(a);return p&&M.close(p),M.dupStream(h,a).fd}catch(_){if(typeof M>"u"||_.name!=="ErrnoError")throw _;return-_.errno}}var It=()=>{G(ht.varargs!=null);var r=De[+ht.varargs>>2];return ht.varargs+=4,r},Ot=It;function Un(r,a,l){ht.varargs=l;try{var h=ht.getStreamFromFD(r);switch(a){case 0:{var p=It();if(p<0)return-28;for(;M.streams[p];)p++;var _;return _=M.dupStream(h,p),_.fd}case 1:case 2:return 0;case 3:return h.flags;case 4:{var p=It();return h.flags|=p,0}case 12:{var p=Ot(),w=0;return xt[p+w>>1]=2,0}case 13:case 14:return 0}return-28}catch(A){if(typeof M>"u"||A.name!=="ErrnoError")throw A;return-A.errno}}function Ys(r,a){try{return ht.writeStat(a,M.fstat(r))}catch(l){if(typeof M>"u"||l.name!=="ErrnoError")throw l;return-l.errno}}function kd(r,a,l){ht.varargs=l;try{var h=ht.getStreamFromFD(r);switch(a){case 21509:return h.tty?0:-59;case 21505:{if(!h.tty)return-59;if(h.tty.ops.ioctl_tcgets){var p=h.tty.ops.ioctl_tcgets(h),_=Ot();De[_>>2]=p.c_iflag||0,De[_+4>>2]=p.c_oflag||0,De[_+8>>2]=p.c_cflag||0,De[_+12>>2]=p.c_lflag||0;for(var w=0;w<32;w++)ut[_+w+17]=p.c_cc[w]||0;return 0}return 0}case 21510:case 21511:case 21512:return h.tty?0:-59;case 21506:case 21507:case 21508:{if(!h.tty)return-59;if(h.tty.ops.ioctl_tcsets){for(var _=Ot(),A=De[_>>2],F=De[_+4>>2],X=De[_+8>>2],Q=De[_+12>>2],oe=[],w=0;w<32;w++)oe.push(ut[_+w+17]);return h.tty.ops.ioctl_tcsets(h.tty,a,{c_iflag:A,c_oflag:F,c_cflag:X,c_lflag:Q,c_cc:oe})}return 0}case 21519:{if(!h.tty)return-59;var _=Ot();return De[_>>2]=0,0}case 21520:return h.tty?-28:-59;case 21531:{var _=Ot();return M.ioctl(h,a,_)}case 21523:{if(!h.tty)return-59;if(h.tty.ops.ioctl_tiocgwinsz){var fe=h.tty.ops.ioctl_tiocgwinsz(h.tty),_=Ot();xt[_>>1]=fe[0],xt[_+2>>1]=fe[1]}return 0}case 21524:return h.tty?0:-59;case 21515:return h.tty?0:-59;default:return-28}}catch(ce){if(typeof M>"u"||ce.name!=="ErrnoError")throw ce;return-ce.errno}}function zd(r,a){try{return r=ht.getStr(r),ht.writeStat(a,M.lstat(r))}catch(l){if(typeof M>"u"||l.name!=="ErrnoError")throw l;return-l.errno}}function Gd(r,a,l,h){try{a=ht.getStr(a);var p=h&256,_=h&4096;return h=h&-6401,G(!h,`unknown flags in __syscall_newfstatat: ${h}`),a=ht.calculateAt(r,a,_),ht.writeStat(l,p?M.lstat(a):M.stat(a))}catch(w){if(typeof M>"u"||w.name!=="ErrnoError")throw w;return-w.errno}}function Vd(r,a,l,h){ht.varargs=h;try{a=ht.getStr(a),a=ht.calculateAt(r,a);var p=h?It():0;return M.open(a,l,p).fd}catch(_){if(typeof M>"u"||_.name!=="ErrnoError")throw _;return-_.errno}}function Hd(r,a){try{return r=ht.getStr(r),ht.writeStat(a,M.stat(r))}catch(l){if(typeof M>"u"||l.name!=="ErrnoError")throw l;return-l.errno}}var Wd=()=>pe("native code called abort()"),qt=r=>{for(var a="";;){var l=Ct[r++];if(!l)return a;a+=String.fromCharCode(l)}},ur={},$i={},js={},Zr=class extends Error{constructor(a){super(a),this.name="BindingError"}},_t=r=>{throw new Zr(r)};function Xd(r,a,l={}){var h=a.name;if(r||_t(`type "${h}" must have a positive integer typeid pointer`),$i.hasOwnProperty(r)){if(l.ignoreDuplicateRegistrations)return;_t(`Cannot register type '${h}' twice`)}if($i[r]=a,delete js[r],ur.hasOwnProperty(r)){var p=ur[r];delete ur[r],p.forEach(_=>_())}}function Ln(r,a,l={}){if(a.argPackAdvance===void 0)throw new TypeError("registerType registeredInstance requires argPackAdvance");return Xd(r,a,l)}var Kc=(r,a,l)=>{switch(a){case 1:return l?h=>ut[h]:h=>Ct[h];case 2:return l?h=>xt[h>>1]:h=>Qt[h>>1];case 4:return l?h=>De[h>>2]:h=>$e[h>>2];case 8:return l?h=>W[h>>3]:h=>pn[h>>3];default:throw new TypeError(`invalid integer width (${a}): ${r}`)}},qi=r=>{if(r===null)return"null";var a=typeof r;return a==="object"||a==="array"||a==="function"?r.toString():""+r},Qc=(r,a,l,h)=>{if(a<l||a>h)throw new TypeError(`Passing a number "${qi(a)}" from JS side to C/C++ side to an argument of type "${r}", which is outside the valid range [${l}, ${h}]!`)},$d=(r,a,l,h,p)=>{a=qt(a);let _=h===0n,w=A=>A;if(_){let A=l*8;w=F=>BigInt.asUintN(A,F),p=w(p)}Ln(r,{name:a,fromWireType:w,toWireType:(A,F)=>{if(typeof F=="number")F=BigInt(F);else if(typeof F!="bigint")throw new TypeError(`Cannot convert "${qi(F)}" to ${this.name}`);return Qc(a,F,h,p),F},argPackAdvance:Qn,readValueFromPointer:Kc(a,l,!_),destructorFunction:null})},Qn=8,qd=(r,a,l,h)=>{a=qt(a),Ln(r,{name:a,fromWireType:function(p){return!!p},toWireType:function(p,_){return _?l:h},argPackAdvance:Qn,readValueFromPointer:function(p){return this.fromWireType(Ct[p])},destructorFunction:null})},Yd=r=>({count:r.count,deleteScheduled:r.deleteScheduled,preservePointerOnDelete:r.preservePointerOnDelete,ptr:r.ptr,ptrType:r.ptrType,smartPtr:r.smartPtr,smartPtrType:r.smartPtrType}),ul=r=>{function a(l){return l.$$.ptrType.registeredClass.name}_t(a(r)+" instance already deleted")},dl=!1,eh=r=>{},jd=r=>{r.smartPtr?r.smartPtrType.rawDestructor(r.smartPtr):r.ptrType.registeredClass.rawDestructor(r.ptr)},th=r=>{r.count.value-=1;var a=r.count.value===0;a&&jd(r)},nh=(r,a,l)=>{if(a===l)return r;if(l.baseClass===void 0)return null;var h=nh(r,a,l.baseClass);return h===null?null:l.downcast(h)},ih={},Zd={},Jd=(r,a)=>{for(a===void 0&&_t("ptr should not be undefined");r.baseClass;)a=r.upcast(a),r=r.baseClass;return a},Kd=(r,a)=>(a=Jd(r,a),Zd[a]),Qd=class extends Error{constructor(a){super(a),this.name="InternalError"}},Zs=r=>{throw new Qd(r)},Js=(r,a)=>{(!a.ptrType||!a.ptr)&&Zs("makeClassHandle requires ptr and ptrType");var l=!!a.smartPtrType,h=!!a.smartPtr;return l!==h&&Zs("Both smartPtrType and smartPtr must be specified"),a.count={value:1},Jr(Object.create(r,{$$:{value:a,writable:!0}}))};function rh(r){var a=this.getPointee(r);if(!a)return this.destructor(r),null;var l=Kd(this.registeredClass,a);if(l!==void 0){if(l.$$.count.value===0)return l.$$.ptr=a,l.$$.smartPtr=r,l.clone();var h=l.clone();return this.destructor(r),h}function p(){return this.isSmartPointer?Js(this.registeredClass.instancePrototype,{ptrType:this.pointeeType,ptr:a,smartPtrType:this,smartPtr:r}):Js(this.registeredClass.instancePrototype,{ptrType:this,ptr:r})}var _=this.registeredClass.getActualType(a),w=ih[_];if(!w)return p.call(this);var A;this.isConst?A=w.constPointerType:A=w.pointerType;var F=nh(a,this.registeredClass,A.registeredClass);return F===null?p.call(this):this.isSmartPointer?Js(A.registeredClass.instancePrototype,{ptrType:A,ptr:F,smartPtrType:this,smartPtr:r}):Js(A.registeredClass.instancePrototype,{ptrType:A,ptr:F})}var Jr=r=>typeof FinalizationRegistry>"u"?(Jr=a=>a,r):(dl=new FinalizationRegistry(a=>{console.warn(a.leakWarning),th(a.$$)}),Jr=a=>{var l=a.$$,h=!!l.smartPtr;if(h){var p={$$:l},_=l.ptrType.registeredClass,w=new Error(`Embind found a leaked C++ instance ${_.name} <${Ut(l.ptr)}>.
We'll free it automatically in this case, but this functionality is not reliable across various environments.
Make sure to invoke .delete() manually once you're done with the instance instead.
Originally allocated`);"captureStackTrace"in Error&&Error.captureStackTrace(w,rh),p.leakWarning=w.stack.replace(/^Error: /,""),dl.register(a,p,a)}return a},eh=a=>dl.unregister(a),Jr(r)),Ks=[],ef=()=>{for(;Ks.length;){var r=Ks.pop();r.$$.deleteScheduled=!1,r.delete()}},sh,tf=()=>{let r=Qs.prototype;Object.assign(r,{isAliasOf(l){if(!(this instanceof Qs)||!(l instanceof Qs))return!1;var h=this.$$.ptrType.registeredClass,p=this.$$.ptr;l.$$=l.$$;for(var _=l.$$.ptrType.registeredClass,w=l.$$.ptr;h.baseClass;)p=h.upcast(p),h=h.baseClass;for(;_.baseClass;)w=_.upcast(w),_=_.baseClass;return h===_&&p===w},clone(){if(this.$$.ptr||ul(this),this.$$.preservePointerOnDelete)return this.$$.count.value+=1,this;var l=Jr(Object.create(Object.getPrototypeOf(this),{$$:{value:Yd(this.$$)}}));return l.$$.count.value+=1,l.$$.deleteScheduled=!1,l},delete(){this.$$.ptr||ul(this),this.$$.deleteScheduled&&!this.$$.preservePointerOnDelete&&_t("Object already scheduled for deletion"),eh(this),th(this.$$),this.$$.preservePointerOnDelete||(this.$$.smartPtr=void 0,this.$$.ptr=void 0)},isDeleted(){return!this.$$.ptr},deleteLater(){return this.$$.ptr||ul(this),this.$$.deleteScheduled&&!this.$$.preservePointerOnDelete&&_t("Object already scheduled for deletion"),Ks.push(this),Ks.length===1&&sh&&sh(ef),this.$$.deleteScheduled=!0,this}});let a=Symbol.dispose;a&&(r[a]=r.delete)};function Qs(){}var ea=(r,a)=>Object.defineProperty(a,"name",{value:r}),fl=(r,a,l)=>{if(r[a].overloadTable===void 0){var h=r[a];r[a]=function(...p){return r[a].overloadTable.hasOwnProperty(p.length)||_t(`Function '${l}' called with an invalid number of arguments (${p.length}) - expects one of (${r[a].overloadTable})!`),r[a].overloadTable[p.length].apply(this,p)},r[a].overloadTable=[],r[a].overloadTable[h.argCount]=h}},pl=(r,a,l)=>{t.hasOwnProperty(r)?((l===void 0||t[r].overloadTable!==void 0&&t[r].overloadTable[l]!==void 0)&&_t(`Cannot register public name '${r}' twice`),fl(t,r,r),t[r].overloadTable.hasOwnProperty(l)&&_t(`Cannot register multiple overloads of a function with the same number of arguments (${l})!`),t[r].overloadTable[l]=a):(t[r]=a,t[r].argCount=l)},nf=48,rf=57,sf=r=>{G(typeof r=="string"),r=r.replace(/[^a-zA-Z0-9_]/g,"$");var a=r.charCodeAt(0);return a>=nf&&a<=rf?`_${r}`:r};function af(r,a,l,h,p,_,w,A){this.name=r,this.constructor=a,this.instancePrototype=l,this.rawDestructor=h,this.baseClass=p,this.getActualType=_,this.upcast=w,this.downcast=A,this.pureVirtualFunctions=[]}var ta=(r,a,l)=>{for(;a!==l;)a.upcast||_t(`Expected null or instance of ${l.name}, got an instance of ${a.name}`),r=a.upcast(r),a=a.baseClass;return r};function of(r,a){if(a===null)return this.isReference&&_t(`null is not a valid ${this.name}`),0;a.$$||_t(`Cannot pass "${qi(a)}" as a ${this.name}`),a.$$.ptr||_t(`Cannot pass deleted object as a pointer of type ${this.name}`);var l=a.$$.ptrType.registeredClass,h=ta(a.$$.ptr,l,this.registeredClass);return h}function lf(r,a){var l;if(a===null)return this.isReference&&_t(`null is not a valid ${this.name}`),this.isSmartPointer?(l=this.rawConstructor(),r!==null&&r.push(this.rawDestructor,l),l):0;(!a||!a.$$)&&_t(`Cannot pass "${qi(a)}" as a ${this.name}`),a.$$.ptr||_t(`Cannot pass deleted object as a pointer of type ${this.name}`),!this.isConst&&a.$$.ptrType.isConst&&_t(`Cannot convert argument of type ${a.$$.smartPtrType?a.$$.smartPtrType.name:a.$$.ptrType.name} to parameter type ${this.name}`);var h=a.$$.ptrType.registeredClass;if(l=ta(a.$$.ptr,h,this.registeredClass),this.isSmartPointer)switch(a.$$.smartPtr===void 0&&_t("Passing raw pointer to smart pointer is illegal"),this.sharingPolicy){case 0:a.$$.smartPtrType===this?l=a.$$.smartPtr:_t(`Cannot convert argument of type ${a.$$.smartPtrType?a.$$.smartPtrType.name:a.$$.ptrType.name} to parameter type ${this.name}`);break;case 1:l=a.$$.smartPtr;break;case 2:if(a.$$.smartPtrType===this)l=a.$$.smartPtr;else{var p=a.clone();l=this.rawShare(l,Yt.toHandle(()=>p.delete())),r!==null&&r.push(this.rawDestructor,l)}break;default:_t("Unsupporting sharing policy")}return l}function cf(r,a){if(a===null)return this.isReference&&_t(`null is not a valid ${this.name}`),0;a.$$||_t(`Cannot pass "${qi(a)}" as a ${this.name}`),a.$$.ptr||_t(`Cannot pass deleted object as a pointer of type ${this.name}`),a.$$.ptrType.isConst&&_t(`Cannot convert argument of type ${a.$$.ptrType.name} to parameter type ${this.name}`);var l=a.$$.ptrType.registeredClass,h=ta(a.$$.ptr,l,this.registeredClass);return h}function na(r){return this.fromWireType($e[r>>2])}var hf=()=>{Object.assign(ia.prototype,{getPointee(r){return this.rawGetPointee&&(r=this.rawGetPointee(r)),r},destructor(r){this.rawDestructor?.(r)},argPackAdvance:Qn,readValueFromPointer:na,fromWireType:rh})};function ia(r,a,l,h,p,_,w,A,F,X,Q){this.name=r,this.registeredClass=a,this.isReference=l,this.isConst=h,this.isSmartPointer=p,this.pointeeType=_,this.sharingPolicy=w,this.rawGetPointee=A,this.rawConstructor=F,this.rawShare=X,this.rawDestructor=Q,!p&&a.baseClass===void 0?h?(this.toWireType=of,this.destructorFunction=null):(this.toWireType=cf,this.destructorFunction=null):this.toWireType=lf}var ah=(r,a,l)=>{t.hasOwnProperty(r)||Zs("Replacing nonexistent public symbol"),t[r].overloadTable!==void 0&&l!==void 0?t[r].overloadTable[l]=a:(t[r]=a,t[r].argCount=l)},oh=[],ra,be=r=>{var a=oh[r];return a||(oh[r]=a=ra.get(r)),G(ra.get(r)==a,"JavaScript-side Wasm function table mirror is out of date!"),a},ei=(r,a,l=!1)=>{G(!l,"Async bindings are only supported with JSPI."),r=qt(r);function h(){var _=be(a);return _}var p=h();return typeof p!="function"&&_t(`unknown function pointer with signature ${r}: ${a}`),p};class uf extends Error{}var lh=r=>{var a=Th(r),l=qt(a);return Bn(a),l},Yi=(r,a)=>{var l=[],h={};function p(_){if(!h[_]&&!$i[_]){if(js[_]){js[_].forEach(p);return}l.push(_),h[_]=!0}}throw a.forEach(p),new uf(`${r}: `+l.map(lh).join([", "]))},On=(r,a,l)=>{r.forEach(A=>js[A]=a);function h(A){var F=l(A);F.length!==r.length&&Zs("Mismatched type converter count");for(var X=0;X<r.length;++X)Ln(r[X],F[X])}var p=new Array(a.length),_=[],w=0;a.forEach((A,F)=>{$i.hasOwnProperty(A)?p[F]=$i[A]:(_.push(A),ur.hasOwnProperty(A)||(ur[A]=[]),ur[A].push(()=>{p[F]=$i[A],++w,w===_.length&&h(p)}))}),_.length===0&&h(p)},df=(r,a,l,h,p,_,w,A,F,X,Q,oe,fe)=>{Q=qt(Q),_=ei(p,_),A&&=ei(w,A),X&&=ei(F,X),fe=ei(oe,fe);var ce=sf(Q);pl(ce,function(){Yi(`Cannot construct ${Q} due to unbound types`,[h])}),On([r,a,l],h?[h]:[],_e=>{_e=_e[0];var Je,vt;h?(Je=_e.registeredClass,vt=Je.instancePrototype):vt=Qs.prototype;var pt=ea(Q,function(...Dt){if(Object.getPrototypeOf(this)!==Nt)throw new Zr(`Use 'new' to construct ${Q}`);if(Mt.constructor_body===void 0)throw new Zr(`${Q} has no accessible constructor`);var Ji=Mt.constructor_body[Dt.length];if(Ji===void 0)throw new Zr(`Tried to invoke ctor of ${Q} with invalid number of parameters (${Dt.length}) - expected (${Object.keys(Mt.constructor_body).toString()}) parameters instead!`);return Ji.apply(this,Dt)}),Nt=Object.create(vt,{constructor:{value:pt}});pt.prototype=Nt;var Mt=new af(Q,pt,Nt,fe,Je,_,A,X);Mt.baseClass&&(Mt.baseClass.__derivedClasses??=[],Mt.baseClass.__derivedClasses.push(Mt));var cn=new ia(Q,Mt,!0,!1,!1),jt=new ia(Q+"*",Mt,!1,!1,!1),mn=new ia(Q+" const*",Mt,!1,!0,!1);return ih[r]={pointerType:jt,constPointerType:mn},ah(ce,pt),[cn,jt,mn]})},ml=r=>{for(;r.length;){var a=r.pop(),l=r.pop();l(a)}};function ch(r){for(var a=1;a<r.length;++a)if(r[a]!==null&&r[a].destructorFunction===void 0)return!0;return!1}function ff(r,a,l,h,p){if(r<a||r>l){var _=a==l?a:`${a} to ${l}`;p(`function ${h} called with ${r} arguments, expected ${_}`)}}function pf(r,a,l,h){var p=ch(r),_=r.length-2,w=[],A=["fn"];a&&A.push("thisWired");for(var F=0;F<_;++F)w.push(`arg${F}`),A.push(`arg${F}Wired`);w=w.join(","),A=A.join(",");var X=`return function (${w}) {
`;X+=`checkArgCount(arguments.length, minArgs, maxArgs, humanName, throwBindingError);
`,p&&(X+=`var destructors = [];
`);var Q=p?"destructors":"null",oe=["humanName","throwBindingError","invoker","fn","runDestructors","retType","classParam"];a&&(X+=`var thisWired = classParam['toWireType'](${Q}, this);
`);for(var F=0;F<_;++F)X+=`var arg${F}Wired = argType${F}['toWireType'](${Q}, arg${F});
`,oe.push(`argType${F}`);X+=(l||h?"var rv = ":"")+`invoker(${A});
`;var fe=l?"rv":"";if(p)X+=`runDestructors(destructors);
`;else for(var F=a?1:2;F<r.length;++F){var ce=F===1?"thisWired":"arg"+(F-2)+"Wired";r[F].destructorFunction!==null&&(X+=`${ce}_dtor(${ce});
`,oe.push(`${ce}_dtor`))}return l&&(X+=`var ret = retType['fromWireType'](rv);
return ret;
`),X+=`}
`,oe.push("checkArgCount","minArgs","maxArgs"),X=`if (arguments.length !== ${oe.length}){ throw new Error(humanName + "Expected ${oe.length} closure arguments " + arguments.length + " given."); }
${X}`,[oe,X]}function mf(r){for(var a=r.length-2,l=r.length-1;l>=2&&r[l].optional;--l)a--;return a}function sa(r,a,l,h,p,_){var w=a.length;w<2&&_t("argTypes array size mismatch! Must at least get return value and 'this' types!"),G(!_,"Async bindings are only supported with JSPI.");for(var A=a[1]!==null&&l!==null,F=ch(a),X=a[0].name!=="void",Q=w-2,oe=mf(a),fe=[r,_t,h,p,ml,a[0],a[1]],ce=0;ce<w-2;++ce)fe.push(a[ce+2]);if(!F)for(var ce=A?1:2;ce<a.length;++ce)a[ce].destructorFunction!==null&&fe.push(a[ce].destructorFunction);fe.push(ff,oe,Q);let[_e,Je]=pf(a,A,X,_);var vt=new Function(..._e,Je)(...fe);return ea(r,vt)}var aa=(r,a)=>{for(var l=[],h=0;h<r;h++)l.push($e[a+h*4>>2]);return l},gl=r=>{r=r.trim();let a=r.indexOf("(");return a===-1?r:(G(r.endsWith(")"),"Parentheses for argument names should match."),r.slice(0,a))},gf=(r,a,l,h,p,_,w,A,F)=>{var X=aa(l,h);a=qt(a),a=gl(a),_=ei(p,_,A),On([],[r],Q=>{Q=Q[0];var oe=`${Q.name}.${a}`;function fe(){Yi(`Cannot call ${oe} due to unbound types`,X)}a.startsWith("@@")&&(a=Symbol[a.substring(2)]);var ce=Q.registeredClass.constructor;return ce[a]===void 0?(fe.argCount=l-1,ce[a]=fe):(fl(ce,a,oe),ce[a].overloadTable[l-1]=fe),On([],X,_e=>{var Je=[_e[0],null].concat(_e.slice(1)),vt=sa(oe,Je,null,_,w,A);if(ce[a].overloadTable===void 0?(vt.argCount=l-1,ce[a]=vt):ce[a].overloadTable[l-1]=vt,Q.registeredClass.__derivedClasses)for(let pt of Q.registeredClass.__derivedClasses)pt.constructor.hasOwnProperty(a)||(pt.constructor[a]=vt);return[]}),[]})},_f=(r,a,l,h,p,_)=>{G(a>0);var w=aa(a,l);p=ei(h,p);var A=[_],F=[];On([],[r],X=>{X=X[0];var Q=`constructor ${X.name}`;if(X.registeredClass.constructor_body===void 0&&(X.registeredClass.constructor_body=[]),X.registeredClass.constructor_body[a-1]!==void 0)throw new Zr(`Cannot register multiple constructors with identical number of parameters (${a-1}) for class '${X.name}'! Overload resolution is currently only performed using the parameter count, not actual type info!`);return X.registeredClass.constructor_body[a-1]=()=>{Yi(`Cannot construct ${X.name} due to unbound types`,w)},On([],w,oe=>(oe.splice(1,0,null),X.registeredClass.constructor_body[a-1]=sa(Q,oe,null,p,_),[])),[]})},vf=(r,a,l,h,p,_,w,A,F,X)=>{var Q=aa(l,h);a=qt(a),a=gl(a),_=ei(p,_,F),On([],[r],oe=>{oe=oe[0];var fe=`${oe.name}.${a}`;a.startsWith("@@")&&(a=Symbol[a.substring(2)]),A&&oe.registeredClass.pureVirtualFunctions.push(a);function ce(){Yi(`Cannot call ${fe} due to unbound types`,Q)}var _e=oe.registeredClass.instancePrototype,Je=_e[a];return Je===void 0||Je.overloadTable===void 0&&Je.className!==oe.name&&Je.argCount===l-2?(ce.argCount=l-2,ce.className=oe.name,_e[a]=ce):(fl(_e,a,fe),_e[a].overloadTable[l-2]=ce),On([],Q,vt=>{var pt=sa(fe,vt,oe,_,w,F);return _e[a].overloadTable===void 0?(pt.argCount=l-2,_e[a]=pt):_e[a].overloadTable[l-2]=pt,[]}),[]})},hh=(r,a,l)=>(r instanceof Object||_t(`${l} with invalid "this": ${r}`),r instanceof a.registeredClass.constructor||_t(`${l} incompatible with "this" of type ${r.constructor.name}`),r.$$.ptr||_t(`cannot call emscripten binding method ${l} on deleted object`),ta(r.$$.ptr,r.$$.ptrType.registeredClass,a.registeredClass)),yf=(r,a,l,h,p,_,w,A,F,X)=>{a=qt(a),p=ei(h,p),On([],[r],Q=>{Q=Q[0];var oe=`${Q.name}.${a}`,fe={get(){Yi(`Cannot access ${oe} due to unbound types`,[l,w])},enumerable:!0,configurable:!0};return F?fe.set=()=>Yi(`Cannot access ${oe} due to unbound types`,[l,w]):fe.set=ce=>_t(oe+" is a read-only property"),Object.defineProperty(Q.registeredClass.instancePrototype,a,fe),On([],F?[l,w]:[l],ce=>{var _e=ce[0],Je={get(){var pt=hh(this,Q,oe+" getter");return _e.fromWireType(p(_,pt))},enumerable:!0};if(F){F=ei(A,F);var vt=ce[1];Je.set=function(pt){var Nt=hh(this,Q,oe+" setter"),Mt=[];F(X,Nt,vt.toWireType(Mt,pt)),ml(Mt)}}return Object.defineProperty(Q.registeredClass.instancePrototype,a,Je),[]}),[]})},xf=(r,a,l)=>{r=qt(r),On([],[a],h=>(h=h[0],t[r]=h.fromWireType(l),[]))},uh=[],ti=[0,1,,1,null,1,!0,1,!1,1],_l=r=>{r>9&&--ti[r+1]===0&&(G(ti[r]!==void 0,"Decref for unallocated handle."),ti[r]=void 0,uh.push(r))},Yt={toValue:r=>(r||_t(`Cannot use deleted val. handle = ${r}`),G(r===2||ti[r]!==void 0&&r%2===0,`invalid handle: ${r}`),ti[r]),toHandle:r=>{switch(r){case void 0:return 2;case null:return 4;case!0:return 6;case!1:return 8;default:{let a=uh.pop()||ti.length;return ti[a]=r,ti[a+1]=1,a}}}},dh={name:"emscripten::val",fromWireType:r=>{var a=Yt.toValue(r);return _l(r),a},toWireType:(r,a)=>Yt.toHandle(a),argPackAdvance:Qn,readValueFromPointer:na,destructorFunction:null},fh=r=>Ln(r,dh),Sf=(r,a,l)=>{switch(a){case 1:return l?function(h){return this.fromWireType(ut[h])}:function(h){return this.fromWireType(Ct[h])};case 2:return l?function(h){return this.fromWireType(xt[h>>1])}:function(h){return this.fromWireType(Qt[h>>1])};case 4:return l?function(h){return this.fromWireType(De[h>>2])}:function(h){return this.fromWireType($e[h>>2])};default:throw new TypeError(`invalid integer width (${a}): ${r}`)}},Mf=(r,a,l,h)=>{a=qt(a);function p(){}p.values={},Ln(r,{name:a,constructor:p,fromWireType:function(_){return this.constructor.values[_]},toWireType:(_,w)=>w.value,argPackAdvance:Qn,readValueFromPointer:Sf(a,l,h),destructorFunction:null}),pl(a,p)},oa=(r,a)=>{var l=$i[r];return l===void 0&&_t(`${a} has unknown type ${lh(r)}`),l},bf=(r,a,l)=>{var h=oa(r,"enum");a=qt(a);var p=h.constructor,_=Object.create(h.constructor.prototype,{value:{value:l},constructor:{value:ea(`${h.name}_${a}`,function(){})}});p.values[l]=_,p[a]=_},Ef=(r,a)=>{switch(a){case 4:return function(l){return this.fromWireType(an[l>>2])};case 8:return function(l){return this.fromWireType(en[l>>3])};default:throw new TypeError(`invalid float width (${a}): ${r}`)}},wf=(r,a,l)=>{a=qt(a),Ln(r,{name:a,fromWireType:h=>h,toWireType:(h,p)=>{if(typeof p!="number"&&typeof p!="boolean")throw new TypeError(`Cannot convert ${qi(p)} to ${this.name}`);return p},argPackAdvance:Qn,readValueFromPointer:Ef(a,l),destructorFunction:null})},Tf=(r,a,l,h,p,_,w,A)=>{var F=aa(a,l);r=qt(r),r=gl(r),p=ei(h,p,w),pl(r,function(){Yi(`Cannot call ${r} due to unbound types`,F)},a-1),On([],F,X=>{var Q=[X[0],null].concat(X.slice(1));return ah(r,sa(r,Q,null,p,_,w),a-1),[]})},Af=(r,a,l,h,p)=>{a=qt(a);let _=h===0,w=F=>F;if(_){var A=32-8*l;w=F=>F<<A>>>A,p=w(p)}Ln(r,{name:a,fromWireType:w,toWireType:(F,X)=>{if(typeof X!="number"&&typeof X!="boolean")throw new TypeError(`Cannot convert "${qi(X)}" to ${a}`);return Qc(a,X,h,p),X},argPackAdvance:Qn,readValueFromPointer:Kc(a,l,h!==0),destructorFunction:null})},Rf=(r,a,l)=>{var h=[Int8Array,Uint8Array,Int16Array,Uint16Array,Int32Array,Uint32Array,Float32Array,Float64Array,BigInt64Array,BigUint64Array],p=h[a];function _(w){var A=$e[w>>2],F=$e[w+4>>2];return new p(ut.buffer,F,A)}l=qt(l),Ln(r,{name:l,fromWireType:_,argPackAdvance:Qn,readValueFromPointer:_},{ignoreDuplicateRegistrations:!0})},Cf=Object.assign({optional:!0},dh),Pf=(r,a)=>{Ln(r,Cf)},ji=(r,a,l)=>(G(typeof l=="number","stringToUTF8(str, outPtr, maxBytesToWrite) is missing the third parameter that specifies the length of the output buffer!"),it(r,Ct,a,l)),If=(r,a)=>{a=qt(a);var l=!0;Ln(r,{name:a,fromWireType(h){var p=$e[h>>2],_=h+4,w;if(l)for(var A=_,F=0;F<=p;++F){var X=_+F;if(F==p||Ct[X]==0){var Q=X-A,oe=on(A,Q);w===void 0?w=oe:(w+="\0",w+=oe),A=X+1}}else{for(var fe=new Array(p),F=0;F<p;++F)fe[F]=String.fromCharCode(Ct[_+F]);w=fe.join("")}return Bn(h),w},toWireType(h,p){p instanceof ArrayBuffer&&(p=new Uint8Array(p));var _,w=typeof p=="string";w||ArrayBuffer.isView(p)&&p.BYTES_PER_ELEMENT==1||_t("Cannot pass non-string to std::string"),l&&w?_=Ge(p):_=p.length;var A=Sl(4+_+1),F=A+4;if($e[A>>2]=_,w)if(l)ji(p,F,_+1);else for(var X=0;X<_;++X){var Q=p.charCodeAt(X);Q>255&&(Bn(A),_t("String has UTF-16 code units that do not fit in 8 bits")),Ct[F+X]=Q}else Ct.set(p,F);return h!==null&&h.push(Bn,A),A},argPackAdvance:Qn,readValueFromPointer:na,destructorFunction(h){Bn(h)}})},ph=typeof TextDecoder<"u"?new TextDecoder("utf-16le"):void 0,Df=(r,a)=>{G(r%2==0,"Pointer passed to UTF16ToString must be aligned to two bytes!");for(var l=r>>1,h=l+a/2,p=l;!(p>=h)&&Qt[p];)++p;if(p-l>16&&ph)return ph.decode(Qt.subarray(l,p));for(var _="",w=l;!(w>=h);++w){var A=Qt[w];if(A==0)break;_+=String.fromCharCode(A)}return _},Lf=(r,a,l)=>{if(G(a%2==0,"Pointer passed to stringToUTF16 must be aligned to two bytes!"),G(typeof l=="number","stringToUTF16(str, outPtr, maxBytesToWrite) is missing the third parameter that specifies the length of the output buffer!"),l??=2147483647,l<2)return 0;l-=2;for(var h=a,p=l<r.length*2?l/2:r.length,_=0;_<p;++_){var w=r.charCodeAt(_);xt[a>>1]=w,a+=2}return xt[a>>1]=0,a-h},Ff=r=>r.length*2,Nf=(r,a)=>{G(r%4==0,"Pointer passed to UTF32ToString must be aligned to four bytes!");for(var l="",h=0;!(h>=a/4);h++){var p=De[r+h*4>>2];if(!p)break;l+=String.fromCodePoint(p)}return l},Uf=(r,a,l)=>{if(G(a%4==0,"Pointer passed to stringToUTF32 must be aligned to four bytes!"),G(typeof l=="number","stringToUTF32(str, outPtr, maxBytesToWrite) is missing the third parameter that specifies the length of the output buffer!"),l??=2147483647,l<4)return 0;for(var h=a,p=h+l-4,_=0;_<r.length;++_){var w=r.codePointAt(_);if(w>65535&&_++,De[a>>2]=w,a+=4,a+4>p)break}return De[a>>2]=0,a-h},Of=r=>{for(var a=0,l=0;l<r.length;++l){var h=r.codePointAt(l);h>65535&&l++,a+=4}return a},Bf=(r,a,l)=>{l=qt(l);var h,p,_,w;a===2?(h=Df,p=Lf,w=Ff,_=A=>Qt[A>>1]):a===4&&(h=Nf,p=Uf,w=Of,_=A=>$e[A>>2]),Ln(r,{name:l,fromWireType:A=>{for(var F=$e[A>>2],X,Q=A+4,oe=0;oe<=F;++oe){var fe=A+4+oe*a;if(oe==F||_(fe)==0){var ce=fe-Q,_e=h(Q,ce);X===void 0?X=_e:(X+="\0",X+=_e),Q=fe+a}}return Bn(A),X},toWireType:(A,F)=>{typeof F!="string"&&_t(`Cannot pass non-string to C++ string type ${l}`);var X=w(F),Q=Sl(4+X+a);return $e[Q>>2]=X/a,p(F,Q+4,X+a),A!==null&&A.push(Bn,Q),Q},argPackAdvance:Qn,readValueFromPointer:na,destructorFunction(A){Bn(A)}})},kf=(r,a)=>{fh(r)},zf=(r,a)=>{a=qt(a),Ln(r,{isVoid:!0,name:a,argPackAdvance:0,fromWireType:()=>{},toWireType:(l,h)=>{}})},Gf=()=>{throw new me},mh=(r,a,l)=>{var h=[],p=r.toWireType(h,l);return h.length&&($e[a>>2]=Yt.toHandle(h)),p},Vf=(r,a,l)=>(r=Yt.toValue(r),a=oa(a,"emval::as"),mh(a,l,r)),la=[],Hf=(r,a,l,h)=>(r=la[r],a=Yt.toValue(a),r(null,a,l,h)),Wf={},vl=r=>{var a=Wf[r];return a===void 0?qt(r):a},Xf=(r,a,l,h,p)=>(r=la[r],a=Yt.toValue(a),l=vl(l),r(a,a[l],h,p)),gh=()=>globalThis,$f=r=>r===0?Yt.toHandle(gh()):(r=vl(r),Yt.toHandle(gh()[r])),qf=r=>{var a=la.length;return la.push(r),a},Yf=(r,a)=>{for(var l=new Array(r),h=0;h<r;++h)l[h]=oa($e[a+h*4>>2],`parameter ${h}`);return l},jf=(r,a,l)=>{var h=Yf(r,a),p=h.shift();r--;var _=`return function (obj, func, destructorsRef, args) {
`,w=0,A=[];l===0&&A.push("obj");for(var F=["retType"],X=[p],Q=0;Q<r;++Q)A.push(`arg${Q}`),F.push(`argType${Q}`),X.push(h[Q]),_+=`  var arg${Q} = argType${Q}.readValueFromPointer(args${w?"+"+w:""});
`,w+=h[Q].argPackAdvance;var oe=l===1?"new func":"func.call";_+=`  var rv = ${oe}(${A.join(", ")});
`,p.isVoid||(F.push("emval_returnValue"),X.push(mh),_+=`  return emval_returnValue(retType, destructorsRef, rv);
`),_+=`};
`;var fe=new Function(...F,_)(...X),ce=`methodCaller<(${h.map(_e=>_e.name).join(", ")}) => ${p.name}>`;return qf(ea(ce,fe))},Zf=(r,a)=>(r=Yt.toValue(r),a=Yt.toValue(a),Yt.toHandle(r[a])),Jf=r=>{r>9&&(ti[r+1]+=1)},Kf=r=>(r=Yt.toValue(r),typeof r=="number"),Qf=r=>(r=Yt.toValue(r),typeof r=="string"),ep=()=>Yt.toHandle([]),tp=r=>Yt.toHandle(vl(r)),np=r=>{var a=Yt.toValue(r);ml(a),_l(r)},ip=(r,a)=>{r=oa(r,"_emval_take_value");var l=r.readValueFromPointer(a);return Yt.toHandle(l)},rp=r=>{throw r=Yt.toValue(r),r},sp=r=>r%4===0&&(r%100!==0||r%400===0),ap=[0,31,60,91,121,152,182,213,244,274,305,335],op=[0,31,59,90,120,151,181,212,243,273,304,334],_h=r=>{var a=sp(r.getFullYear()),l=a?ap:op,h=l[r.getMonth()]+r.getDate()-1;return h},lp=9007199254740992,cp=-9007199254740992,yl=r=>r<cp||r>lp?NaN:Number(r);function hp(r,a){r=yl(r);var l=new Date(r*1e3);De[a>>2]=l.getSeconds(),De[a+4>>2]=l.getMinutes(),De[a+8>>2]=l.getHours(),De[a+12>>2]=l.getDate(),De[a+16>>2]=l.getMonth(),De[a+20>>2]=l.getFullYear()-1900,De[a+24>>2]=l.getDay();var h=_h(l)|0;De[a+28>>2]=h,De[a+36>>2]=-(l.getTimezoneOffset()*60);var p=new Date(l.getFullYear(),0,1),_=new Date(l.getFullYear(),6,1).getTimezoneOffset(),w=p.getTimezoneOffset(),A=(_!=w&&l.getTimezoneOffset()==Math.min(w,_))|0;De[a+32>>2]=A}var up=function(r){var a=(()=>{var l=new Date(De[r+20>>2]+1900,De[r+16>>2],De[r+12>>2],De[r+8>>2],De[r+4>>2],De[r>>2],0),h=De[r+32>>2],p=l.getTimezoneOffset(),_=new Date(l.getFullYear(),0,1),w=new Date(l.getFullYear(),6,1).getTimezoneOffset(),A=_.getTimezoneOffset(),F=Math.min(A,w);if(h<0)De[r+32>>2]=+(w!=A&&F==p);else if(h>0!=(F==p)){var X=Math.max(A,w),Q=h>0?F:X;l.setTime(l.getTime()+(Q-p)*6e4)}De[r+24>>2]=l.getDay();var oe=_h(l)|0;De[r+28>>2]=oe,De[r>>2]=l.getSeconds(),De[r+4>>2]=l.getMinutes(),De[r+8>>2]=l.getHours(),De[r+12>>2]=l.getDate(),De[r+16>>2]=l.getMonth(),De[r+20>>2]=l.getYear();var fe=l.getTime();return isNaN(fe)?-1:fe/1e3})();return BigInt(a)},dp=(r,a,l,h)=>{var p=new Date().getFullYear(),_=new Date(p,0,1),w=new Date(p,6,1),A=_.getTimezoneOffset(),F=w.getTimezoneOffset(),X=Math.max(A,F);$e[r>>2]=X*60,De[a>>2]=+(A!=F);var Q=ce=>{var _e=ce>=0?"-":"+",Je=Math.abs(ce),vt=String(Math.floor(Je/60)).padStart(2,"0"),pt=String(Je%60).padStart(2,"0");return`UTC${_e}${vt}${pt}`},oe=Q(A),fe=Q(F);G(oe),G(fe),G(Ge(oe)<=16,`timezone name truncated to fit in TZNAME_MAX (${oe})`),G(Ge(fe)<=16,`timezone name truncated to fit in TZNAME_MAX (${fe})`),F<A?(ji(oe,l,17),ji(fe,h,17)):(ji(oe,h,17),ji(fe,l,17))},vh=()=>performance.now(),yh=()=>Date.now(),fp=1,pp=r=>r>=0&&r<=3;function mp(r,a,l){if(a=yl(a),!pp(r))return 28;var h;if(r===0)h=yh();else if(fp)h=vh();else return 52;var p=Math.round(h*1e3*1e3);return W[l>>3]=BigInt(p),0}var ca=[],gp=(r,a)=>{G(Array.isArray(ca)),G(a%16==0),ca.length=0;for(var l;l=Ct[r++];){var h=String.fromCharCode(l),p=["d","f","i","p"];p.push("j"),G(p.includes(h),`Invalid character ${l}("${h}") in readEmAsmArgs! Use only [${p}], and do not specify "v" for void return argument.`);var _=l!=105;_&=l!=112,a+=_&&a%8?4:0,ca.push(l==112?$e[a>>2]:l==106?W[a>>3]:l==105?De[a>>2]:en[a>>3]),a+=_?8:4}return ca},_p=(r,a,l)=>{var h=gp(a,l);return G(wh.hasOwnProperty(r),`No EM_ASM constant found at address ${r}.  The loaded WebAssembly file is likely out of sync with the generated JavaScript.`),wh[r](...h)},vp=(r,a,l)=>_p(r,a,l),xh=()=>2147483648,yp=()=>xh(),xp=(r,a)=>(G(a,"alignment argument is required"),Math.ceil(r/a)*a),Sp=r=>{var a=Vt.buffer,l=(r-a.byteLength+65535)/65536|0;try{return Vt.grow(l),Ft(),1}catch(h){I(`growMemory: Attempted to grow heap from ${a.byteLength} bytes to ${r} bytes, but got error: ${h}`)}},Mp=r=>{var a=Ct.length;r>>>=0,G(r>a);var l=xh();if(r>l)return I(`Cannot enlarge memory, requested ${r} bytes, but the limit is ${l} bytes!`),!1;for(var h=1;h<=4;h*=2){var p=a*(1+.2/h);p=Math.min(p,r+100663296);var _=Math.min(l,xp(Math.max(r,p),65536)),w=Sp(_);if(w)return!0}return I(`Failed to grow the heap from ${a} bytes to ${_} bytes, not enough memory!`),!1},xl={},bp=()=>d||"./this.program",Kr=()=>{if(!Kr.strings){var r=(typeof navigator=="object"&&navigator.language||"C").replace("-","_")+".UTF-8",a={USER:"web_user",LOGNAME:"web_user",PATH:"/",PWD:"/",HOME:"/home/web_user",LANG:r,_:bp()};for(var l in xl)xl[l]===void 0?delete a[l]:a[l]=xl[l];var h=[];for(var l in a)h.push(`${l}=${a[l]}`);Kr.strings=h}return Kr.strings},Ep=(r,a)=>{var l=0,h=0;for(var p of Kr()){var _=a+l;$e[r+h>>2]=_,l+=ji(p,_,1/0)+1,h+=4}return 0},wp=(r,a)=>{var l=Kr();$e[r>>2]=l.length;var h=0;for(var p of l)h+=Ge(p)+1;return $e[a>>2]=h,0},Sh=0,Mh=()=>Et||Sh>0,Tp=r=>{ie=r,Mh()||(t.onExit?.(r),z=!0),m(r,new Ae(r))},Ap=(r,a)=>{if(ie=r,Gg(),Mh()&&!a){var l=`program exited (with status: ${r}), but keepRuntimeAlive() is set (counter=${Sh}) due to an async operation, so halting execution but not exiting the runtime or preventing further async execution (you can use emscripten_force_exit, if you want to force a true shutdown)`;dt?.(l),I(l)}Tp(r)},Rp=Ap;function Cp(r){try{var a=ht.getStreamFromFD(r);return M.close(a),0}catch(l){if(typeof M>"u"||l.name!=="ErrnoError")throw l;return l.errno}}var Pp=(r,a,l,h)=>{for(var p=0,_=0;_<l;_++){var w=$e[a>>2],A=$e[a+4>>2];a+=8;var F=M.read(r,ut,w,A,h);if(F<0)return-1;if(p+=F,F<A)break;typeof h<"u"&&(h+=F)}return p};function Ip(r,a,l,h){try{var p=ht.getStreamFromFD(r),_=Pp(p,a,l);return $e[h>>2]=_,0}catch(w){if(typeof M>"u"||w.name!=="ErrnoError")throw w;return w.errno}}function Dp(r,a,l,h){a=yl(a);try{if(isNaN(a))return 61;var p=ht.getStreamFromFD(r);return M.llseek(p,a,l),W[h>>3]=BigInt(p.position),p.getdents&&a===0&&l===0&&(p.getdents=null),0}catch(_){if(typeof M>"u"||_.name!=="ErrnoError")throw _;return _.errno}}var Lp=(r,a,l,h)=>{for(var p=0,_=0;_<l;_++){var w=$e[a>>2],A=$e[a+4>>2];a+=8;var F=M.write(r,ut,w,A,h);if(F<0)return-1;if(p+=F,F<A)break;typeof h<"u"&&(h+=F)}return p};function Fp(r,a,l,h){try{var p=ht.getStreamFromFD(r),_=Lp(p,a,l);return $e[h>>2]=_,0}catch(w){if(typeof M>"u"||w.name!=="ErrnoError")throw w;return w.errno}}var Np=r=>r,Up=r=>{var a=t["_"+r];return G(a,"Cannot call unknown function "+r+", make sure it is exported"),a},Op=(r,a)=>{G(r.length>=0,"writeArrayToMemory array must have a length (should be an array or typed array)"),ut.set(r,a)},ha=r=>Ih(r),Bp=r=>{var a=Ge(r)+1,l=ha(a);return ji(r,l,a),l},bh=(r,a,l,h,p)=>{var _={string:_e=>{var Je=0;return _e!=null&&_e!==0&&(Je=Bp(_e)),Je},array:_e=>{var Je=ha(_e.length);return Op(_e,Je),Je}};function w(_e){return a==="string"?on(_e):a==="boolean"?!!_e:_e}var A=Up(r),F=[],X=0;if(G(a!=="array",'Return type should not be "array".'),h)for(var Q=0;Q<h.length;Q++){var oe=_[l[Q]];oe?(X===0&&(X=ge()),F[Q]=oe(h[Q])):F[Q]=h[Q]}var fe=A(...F);function ce(_e){return X!==0&&ye(X),w(_e)}return fe=ce(fe),fe},kp=(r,a,l,h)=>(...p)=>bh(r,a,l,p,h),zp=(...r)=>M.createPath(...r),Gp=(...r)=>M.unlink(...r),Vp=(...r)=>M.createLazyFile(...r),Hp=(...r)=>M.createDevice(...r),Wp=r=>ua(r),Xp=r=>El(r),$p=r=>{var a=ge(),l=ha(4),h=ha(4);Lh(r,l,h);var p=$e[l>>2],_=$e[h>>2],w=on(p);Bn(p);var A;return _&&(A=on(_),Bn(_)),ye(a),[w,A]},Eh=r=>$p(r);M.createPreloadedFile=Zn,M.staticInit(),tf(),hf(),G(ti.length===10),t.noExitRuntime&&(Et=t.noExitRuntime),t.preloadPlugins&&(tn=t.preloadPlugins),t.print&&(O=t.print),t.printErr&&(I=t.printErr),t.wasmBinary&&(ee=t.wasmBinary),jp(),t.arguments&&(f=t.arguments),t.thisProgram&&(d=t.thisProgram),G(typeof t.memoryInitializerPrefixURL>"u","Module.memoryInitializerPrefixURL option was removed, use Module.locateFile instead"),G(typeof t.pthreadMainPrefixURL>"u","Module.pthreadMainPrefixURL option was removed, use Module.locateFile instead"),G(typeof t.cdInitializerPrefixURL>"u","Module.cdInitializerPrefixURL option was removed, use Module.locateFile instead"),G(typeof t.filePackagePrefixURL>"u","Module.filePackagePrefixURL option was removed, use Module.locateFile instead"),G(typeof t.read>"u","Module.read option was removed"),G(typeof t.readAsync>"u","Module.readAsync option was removed (modify readAsync in JS)"),G(typeof t.readBinary>"u","Module.readBinary option was removed (modify readBinary in JS)"),G(typeof t.setWindowTitle>"u","Module.setWindowTitle option was removed (modify emscripten_set_window_title in JS)"),G(typeof t.TOTAL_MEMORY>"u","Module.TOTAL_MEMORY has been renamed Module.INITIAL_MEMORY"),G(typeof t.ENVIRONMENT>"u","Module.ENVIRONMENT has been deprecated. To force the environment, use the ENVIRONMENT compile-time option (for example, -sENVIRONMENT=web or -sENVIRONMENT=node)"),G(typeof t.STACK_SIZE>"u","STACK_SIZE can no longer be set at runtime.  Use -sSTACK_SIZE at link time"),G(typeof t.wasmMemory>"u","Use of `wasmMemory` detected.  Use -sIMPORTED_MEMORY to define wasmMemory externally"),G(typeof t.INITIAL_MEMORY>"u","Detected runtime INITIAL_MEMORY setting.  Use -sIMPORTED_MEMORY to define wasmMemory dynamically"),t.addRunDependency=ve,t.removeRunDependency=de,t.ccall=bh,t.cwrap=kp,t.FS_createPreloadedFile=Zn,t.FS_unlink=Gp,t.FS_createPath=zp,t.FS_createDevice=Hp,t.FS=M,t.FS_createDataFile=$t,t.FS_createLazyFile=Vp,t.MEMFS=ke;var qp=["writeI53ToI64","writeI53ToI64Clamped","writeI53ToI64Signaling","writeI53ToU64Clamped","writeI53ToU64Signaling","readI53FromI64","readI53FromU64","convertI32PairToI53","convertI32PairToI53Checked","convertU32PairToI53","getTempRet0","zeroMemory","withStackSave","inetPton4","inetNtop4","inetPton6","inetNtop6","readSockaddr","writeSockaddr","emscriptenLog","runMainThreadEmAsm","jstoi_q","autoResumeAudioContext","getDynCaller","dynCall","handleException","runtimeKeepalivePush","runtimeKeepalivePop","callUserCallback","maybeExit","asmjsMangle","HandleAllocator","getNativeTypeSize","addOnInit","addOnPostCtor","addOnPreMain","addOnExit","STACK_SIZE","STACK_ALIGN","POINTER_SIZE","ASSERTIONS","uleb128Encode","sigToWasmTypes","generateFuncType","convertJsFunctionToWasm","getEmptyTableSlot","updateTableMap","getFunctionAddress","addFunction","removeFunction","reallyNegative","unSign","strLen","reSign","formatString","intArrayToString","stringToAscii","stringToNewUTF8","registerKeyEventCallback","maybeCStringToJsString","findEventTarget","getBoundingClientRect","fillMouseEventData","registerMouseEventCallback","registerWheelEventCallback","registerUiEventCallback","registerFocusEventCallback","fillDeviceOrientationEventData","registerDeviceOrientationEventCallback","fillDeviceMotionEventData","registerDeviceMotionEventCallback","screenOrientation","fillOrientationChangeEventData","registerOrientationChangeEventCallback","fillFullscreenChangeEventData","registerFullscreenChangeEventCallback","JSEvents_requestFullscreen","JSEvents_resizeCanvasForFullscreen","registerRestoreOldStyle","hideEverythingExceptGivenElement","restoreHiddenElements","setLetterbox","softFullscreenResizeWebGLRenderTarget","doRequestFullscreen","fillPointerlockChangeEventData","registerPointerlockChangeEventCallback","registerPointerlockErrorEventCallback","requestPointerLock","fillVisibilityChangeEventData","registerVisibilityChangeEventCallback","registerTouchEventCallback","fillGamepadEventData","registerGamepadEventCallback","registerBeforeUnloadEventCallback","fillBatteryEventData","battery","registerBatteryEventCallback","setCanvasElementSize","getCanvasElementSize","jsStackTrace","getCallstack","convertPCtoSourceLocation","wasiRightsToMuslOFlags","wasiOFlagsToMuslOFlags","safeSetTimeout","setImmediateWrapped","safeRequestAnimationFrame","clearImmediateWrapped","registerPostMainLoop","registerPreMainLoop","getPromise","makePromise","idsToPromises","makePromiseCallback","Browser_asyncPrepareDataCounter","arraySum","addDays","getSocketFromFD","getSocketAddress","FS_mkdirTree","_setNetworkCallback","heapObjectForWebGLType","toTypedArrayIndex","webgl_enable_ANGLE_instanced_arrays","webgl_enable_OES_vertex_array_object","webgl_enable_WEBGL_draw_buffers","webgl_enable_WEBGL_multi_draw","webgl_enable_EXT_polygon_offset_clamp","webgl_enable_EXT_clip_control","webgl_enable_WEBGL_polygon_mode","emscriptenWebGLGet","computeUnpackAlignedImageSize","colorChannelsInGlTextureFormat","emscriptenWebGLGetTexPixelData","emscriptenWebGLGetUniform","webglGetUniformLocation","webglPrepareUniformLocationsBeforeFirstUse","webglGetLeftBracePos","emscriptenWebGLGetVertexAttrib","__glGetActiveAttribOrUniform","writeGLArray","registerWebGlEventCallback","runAndAbortIfError","ALLOC_NORMAL","ALLOC_STACK","allocate","writeStringToMemory","writeAsciiToMemory","demangle","stackTrace","getFunctionArgsName","createJsInvokerSignature","PureVirtualError","registerInheritedInstance","unregisterInheritedInstance","getInheritedInstanceCount","getLiveInheritedInstances","setDelayFunction","count_emval_handles"];qp.forEach(Ke);var Yp=["run","out","err","callMain","abort","wasmMemory","wasmExports","HEAPF32","HEAPF64","HEAP8","HEAPU8","HEAP16","HEAPU16","HEAP32","HEAPU32","HEAP64","HEAPU64","writeStackCookie","checkStackCookie","INT53_MAX","INT53_MIN","bigintToI53Checked","stackSave","stackRestore","stackAlloc","setTempRet0","ptrToString","exitJS","getHeapMax","growMemory","ENV","ERRNO_CODES","strError","DNS","Protocols","Sockets","timers","warnOnce","readEmAsmArgsArray","readEmAsmArgs","runEmAsmFunction","getExecutableName","keepRuntimeAlive","asyncLoad","alignMemory","mmapAlloc","wasmTable","getUniqueRunDependency","noExitRuntime","addOnPreRun","addOnPostRun","freeTableIndexes","functionsInTableMap","setValue","getValue","PATH","PATH_FS","UTF8Decoder","UTF8ArrayToString","UTF8ToString","stringToUTF8Array","stringToUTF8","lengthBytesUTF8","intArrayFromString","AsciiToString","UTF16Decoder","UTF16ToString","stringToUTF16","lengthBytesUTF16","UTF32ToString","stringToUTF32","lengthBytesUTF32","stringToUTF8OnStack","writeArrayToMemory","JSEvents","specialHTMLTargets","findCanvasEventTarget","currentFullscreenStrategy","restoreOldWindowedStyle","UNWIND_CACHE","ExitStatus","getEnvStrings","checkWasiClock","doReadv","doWritev","initRandomFill","randomFill","emSetImmediate","emClearImmediate_deps","emClearImmediate","promiseMap","uncaughtExceptionCount","exceptionLast","exceptionCaught","ExceptionInfo","findMatchingCatch","getExceptionMessageCommon","Browser","requestFullscreen","requestFullScreen","setCanvasSize","getUserMedia","createContext","getPreloadedImageData__data","wget","MONTH_DAYS_REGULAR","MONTH_DAYS_LEAP","MONTH_DAYS_REGULAR_CUMULATIVE","MONTH_DAYS_LEAP_CUMULATIVE","isLeapYear","ydayFromDate","SYSCALLS","preloadPlugins","FS_modeStringToFlags","FS_getMode","FS_stdin_getChar_buffer","FS_stdin_getChar","FS_readFile","FS_root","FS_mounts","FS_devices","FS_streams","FS_nextInode","FS_nameTable","FS_currentPath","FS_initialized","FS_ignorePermissions","FS_filesystems","FS_syncFSRequests","FS_readFiles","FS_lookupPath","FS_getPath","FS_hashName","FS_hashAddNode","FS_hashRemoveNode","FS_lookupNode","FS_createNode","FS_destroyNode","FS_isRoot","FS_isMountpoint","FS_isFile","FS_isDir","FS_isLink","FS_isChrdev","FS_isBlkdev","FS_isFIFO","FS_isSocket","FS_flagsToPermissionString","FS_nodePermissions","FS_mayLookup","FS_mayCreate","FS_mayDelete","FS_mayOpen","FS_checkOpExists","FS_nextfd","FS_getStreamChecked","FS_getStream","FS_createStream","FS_closeStream","FS_dupStream","FS_doSetAttr","FS_chrdev_stream_ops","FS_major","FS_minor","FS_makedev","FS_registerDevice","FS_getDevice","FS_getMounts","FS_syncfs","FS_mount","FS_unmount","FS_lookup","FS_mknod","FS_statfs","FS_statfsStream","FS_statfsNode","FS_create","FS_mkdir","FS_mkdev","FS_symlink","FS_rename","FS_rmdir","FS_readdir","FS_readlink","FS_stat","FS_fstat","FS_lstat","FS_doChmod","FS_chmod","FS_lchmod","FS_fchmod","FS_doChown","FS_chown","FS_lchown","FS_fchown","FS_doTruncate","FS_truncate","FS_ftruncate","FS_utime","FS_open","FS_close","FS_isClosed","FS_llseek","FS_read","FS_write","FS_mmap","FS_msync","FS_ioctl","FS_writeFile","FS_cwd","FS_chdir","FS_createDefaultDirectories","FS_createDefaultDevices","FS_createSpecialDirectories","FS_createStandardStreams","FS_staticInit","FS_init","FS_quit","FS_findObject","FS_analyzePath","FS_createFile","FS_forceLoadFile","FS_absolutePath","FS_createFolder","FS_createLink","FS_joinPath","FS_mmapAlloc","FS_standardizePath","TTY","PIPEFS","SOCKFS","tempFixedLengthArray","miniTempWebGLFloatBuffers","miniTempWebGLIntBuffers","GL","AL","GLUT","EGL","GLEW","IDBStore","SDL","SDL_gfx","allocateUTF8","allocateUTF8OnStack","print","printErr","jstoi_s","InternalError","BindingError","throwInternalError","throwBindingError","registeredTypes","awaitingDependencies","typeDependencies","tupleRegistrations","structRegistrations","sharedRegisterType","whenDependentTypesAreResolved","getTypeName","getFunctionName","heap32VectorToArray","requireRegisteredType","usesDestructorStack","checkArgCount","getRequiredArgCount","createJsInvoker","UnboundTypeError","GenericWireTypeSize","EmValType","EmValOptionalType","throwUnboundTypeError","ensureOverloadTable","exposePublicSymbol","replacePublicSymbol","createNamedFunction","embindRepr","registeredInstances","getBasestPointer","getInheritedInstance","registeredPointers","registerType","integerReadValueFromPointer","enumReadValueFromPointer","floatReadValueFromPointer","assertIntegerRange","readPointer","runDestructors","craftInvokerFunction","embind__requireFunction","genericPointerToWireType","constNoSmartPtrRawPointerToWireType","nonConstNoSmartPtrRawPointerToWireType","init_RegisteredPointer","RegisteredPointer","RegisteredPointer_fromWireType","runDestructor","releaseClassHandle","finalizationRegistry","detachFinalizer_deps","detachFinalizer","attachFinalizer","makeClassHandle","init_ClassHandle","ClassHandle","throwInstanceAlreadyDeleted","deletionQueue","flushPendingDeletes","delayFunction","RegisteredClass","shallowCopyInternalPointer","downcastPointer","upcastPointer","validateThis","char_0","char_9","makeLegalFunctionName","emval_freelist","emval_handles","emval_symbols","getStringOrSymbol","Emval","emval_get_global","emval_returnValue","emval_lookupTypes","emval_methodCallers","emval_addMethodCaller"];Yp.forEach(bt),t.incrementExceptionRefcount=Wp,t.decrementExceptionRefcount=Xp,t.getExceptionMessage=Eh;function jp(){Ye("fetchSettings")}var wh={679512:()=>{typeof t<"u"&&"mjDISABLESTRING mjENABLESTRING mjFRAMESTRING mjLABELSTRING mjRNDSTRING mjTIMERSTRING mjVISSTRING".split(" ").forEach(function(r){Object.defineProperty(t,r,{get:function(){return t["get_"+r]()},set:function(a){},enumerable:!0,configurable:!0})})}},Th=Pe("___getTypeName"),Sl=Pe("_malloc"),Zp=Pe("___cxa_free_exception"),Ml=Pe("_fflush"),Bn=Pe("_free"),bl=Pe("_emscripten_stack_get_end"),Jp=Pe("_emscripten_stack_get_base"),Ah=Pe("_strerror"),xe=Pe("_setThrew"),Rh=Pe("__emscripten_tempret_set"),Ch=Pe("_emscripten_stack_init"),Kp=Pe("_emscripten_stack_get_free"),Ph=Pe("__emscripten_stack_restore"),Ih=Pe("__emscripten_stack_alloc"),Dh=Pe("_emscripten_stack_get_current"),El=Pe("___cxa_decrement_exception_refcount"),ua=Pe("___cxa_increment_exception_refcount"),Lh=Pe("___get_exception_message"),Fh=Pe("___cxa_can_catch"),Nh=Pe("___cxa_get_exception_ptr");function Qp(r){Th=Me("__getTypeName",1),Sl=Me("malloc",1),Zp=Me("__cxa_free_exception",1),Ml=Me("fflush",1),Bn=Me("free",1),bl=r.emscripten_stack_get_end,Jp=r.emscripten_stack_get_base,Ah=Me("strerror",1),xe=Me("setThrew",2),Rh=Me("_emscripten_tempret_set",1),Ch=r.emscripten_stack_init,Kp=r.emscripten_stack_get_free,Ph=r._emscripten_stack_restore,Ih=r._emscripten_stack_alloc,Dh=r.emscripten_stack_get_current,El=Me("__cxa_decrement_exception_refcount",1),ua=Me("__cxa_increment_exception_refcount",1),Lh=Me("__get_exception_message",3),Fh=Me("__cxa_can_catch",3),Nh=Me("__cxa_get_exception_ptr",1)}var Uh={__assert_fail:Yr,__cxa_begin_catch:lr,__cxa_current_primary_exception:qs,__cxa_end_catch:Wi,__cxa_find_matching_catch_2:ll,__cxa_find_matching_catch_3:cl,__cxa_find_matching_catch_4:hl,__cxa_rethrow:jr,__cxa_rethrow_primary_exception:R,__cxa_throw:V,__cxa_uncaught_exceptions:te,__resumeException:K,__syscall_dup3:wn,__syscall_fcntl64:Un,__syscall_fstat64:Ys,__syscall_ioctl:kd,__syscall_lstat64:zd,__syscall_newfstatat:Gd,__syscall_openat:Vd,__syscall_stat64:Hd,_abort_js:Wd,_embind_register_bigint:$d,_embind_register_bool:qd,_embind_register_class:df,_embind_register_class_class_function:gf,_embind_register_class_constructor:_f,_embind_register_class_function:vf,_embind_register_class_property:yf,_embind_register_constant:xf,_embind_register_emval:fh,_embind_register_enum:Mf,_embind_register_enum_value:bf,_embind_register_float:wf,_embind_register_function:Tf,_embind_register_integer:Af,_embind_register_memory_view:Rf,_embind_register_optional:Pf,_embind_register_std_string:If,_embind_register_std_wstring:Bf,_embind_register_user_type:kf,_embind_register_void:zf,_emscripten_throw_longjmp:Gf,_emval_as:Vf,_emval_call:Hf,_emval_call_method:Xf,_emval_decref:_l,_emval_get_global:$f,_emval_get_method_caller:jf,_emval_get_property:Zf,_emval_incref:Jf,_emval_is_number:Kf,_emval_is_string:Qf,_emval_new_array:ep,_emval_new_cstring:tp,_emval_run_destructors:np,_emval_take_value:ip,_emval_throw:rp,_localtime_js:hp,_mktime_js:up,_tzset_js:dp,clock_time_get:mp,emscripten_asm_const_int:vp,emscripten_date_now:yh,emscripten_get_heap_max:yp,emscripten_get_now:vh,emscripten_resize_heap:Mp,environ_get:Ep,environ_sizes_get:wp,exit:Rp,fd_close:Cp,fd_read:Ip,fd_seek:Dp,fd_write:Fp,invoke_ddd:Tg,invoke_dddi:Hm,invoke_dddidi:Wm,invoke_ddidi:Vm,invoke_di:Xm,invoke_dii:Lm,invoke_diii:fm,invoke_diiii:Gm,invoke_diiiidd:km,invoke_diiiidi:gm,invoke_diiiii:lm,invoke_diiiiii:Mm,invoke_diiiiiii:$m,invoke_diiiiiiiii:xm,invoke_diiiiiiiiiiii:Sm,invoke_fiii:Og,invoke_i:cm,invoke_id:ug,invoke_ii:nm,invoke_iid:ng,invoke_iidddd:Ig,invoke_iidiii:Pm,invoke_iidiiid:Rm,invoke_iidiiiiidi:Im,invoke_iif:Pg,invoke_iii:em,invoke_iiid:Dm,invoke_iiididdddddd:Cm,invoke_iiidiiiiiiii:Am,invoke_iiii:sm,invoke_iiiidddiiiii:Ym,invoke_iiiii:dm,invoke_iiiiid:fg,invoke_iiiiii:og,invoke_iiiiiii:rg,invoke_iiiiiiii:tg,invoke_iiiiiiiidd:pg,invoke_iiiiiiiii:Bm,invoke_iiiiiiiiii:sg,invoke_iiiiiiiiiidddiiiiiiiii:Tm,invoke_iiiiiiiiiii:Ug,invoke_iiiiiiiiiiii:Bg,invoke_iiiiiiiiiiiii:yg,invoke_iiij:ag,invoke_iiji:dg,invoke_j:Fg,invoke_ji:Eg,invoke_jiiii:lg,invoke_jij:wg,invoke_v:rm,invoke_vi:im,invoke_vid:ig,invoke_viddd:cg,invoke_vidddd:hg,invoke_vidi:zm,invoke_vidiii:Em,invoke_vii:om,invoke_viid:Um,invoke_viiddi:vg,invoke_viiddidi:_g,invoke_viiddii:qm,invoke_viidi:Nm,invoke_viidii:mm,invoke_viidiii:Qm,invoke_viidiiid:Jm,invoke_viidiiiii:wm,invoke_viidiiiiidi:eg,invoke_viidiiiiiiii:bm,invoke_viii:tm,invoke_viiid:vm,invoke_viiidd:gg,invoke_viiidi:Fm,invoke_viiididdddddd:Km,invoke_viiidiiiiiiii:Zm,invoke_viiii:um,invoke_viiiiddd:mg,invoke_viiiidi:Ag,invoke_viiiifi:Rg,invoke_viiiii:am,invoke_viiiiid:_m,invoke_viiiiii:hm,invoke_viiiiiii:pm,invoke_viiiiiiii:Om,invoke_viiiiiiiiii:Mg,invoke_viiiiiiiiiidddiiiiiiiii:jm,invoke_viiiiiiiiiiid:ym,invoke_viiiiiiiiiiiii:Sg,invoke_viiiiiiiiiiiiiii:kg,invoke_viiiiiiiiiiiiiiiiii:bg,invoke_viiiij:Dg,invoke_viij:Lg,invoke_viijii:Ng,invoke_vij:Cg,invoke_vijjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjjj:xg,llvm_eh_typeid_for:Np},Zi=await we();function em(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function tm(r,a,l,h){var p=ge();try{be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function nm(r,a){var l=ge();try{return be(r)(a)}catch(h){if(ye(l),!(h instanceof H))throw h;xe(1,0)}}function im(r,a){var l=ge();try{be(r)(a)}catch(h){if(ye(l),!(h instanceof H))throw h;xe(1,0)}}function rm(r){var a=ge();try{be(r)()}catch(l){if(ye(a),!(l instanceof H))throw l;xe(1,0)}}function sm(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function am(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function om(r,a,l){var h=ge();try{be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function lm(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function cm(r){var a=ge();try{return be(r)()}catch(l){if(ye(a),!(l instanceof H))throw l;xe(1,0)}}function hm(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function um(r,a,l,h,p){var _=ge();try{be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function dm(r,a,l,h,p){var _=ge();try{return be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function fm(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function pm(r,a,l,h,p,_,w,A){var F=ge();try{be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function mm(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function gm(r,a,l,h,p,_,w){var A=ge();try{return be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function _m(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function vm(r,a,l,h,p){var _=ge();try{be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function ym(r,a,l,h,p,_,w,A,F,X,Q,oe,fe){var ce=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe)}catch(_e){if(ye(ce),!(_e instanceof H))throw _e;xe(1,0)}}function xm(r,a,l,h,p,_,w,A,F,X){var Q=ge();try{return be(r)(a,l,h,p,_,w,A,F,X)}catch(oe){if(ye(Q),!(oe instanceof H))throw oe;xe(1,0)}}function Sm(r,a,l,h,p,_,w,A,F,X,Q,oe,fe){var ce=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe)}catch(_e){if(ye(ce),!(_e instanceof H))throw _e;xe(1,0)}}function Mm(r,a,l,h,p,_,w){var A=ge();try{return be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function bm(r,a,l,h,p,_,w,A,F,X,Q,oe){var fe=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe)}catch(ce){if(ye(fe),!(ce instanceof H))throw ce;xe(1,0)}}function Em(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function wm(r,a,l,h,p,_,w,A,F){var X=ge();try{be(r)(a,l,h,p,_,w,A,F)}catch(Q){if(ye(X),!(Q instanceof H))throw Q;xe(1,0)}}function Tm(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt){var mn=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt)}catch(Dt){if(ye(mn),!(Dt instanceof H))throw Dt;xe(1,0)}}function Am(r,a,l,h,p,_,w,A,F,X,Q,oe){var fe=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe)}catch(ce){if(ye(fe),!(ce instanceof H))throw ce;xe(1,0)}}function Rm(r,a,l,h,p,_,w){var A=ge();try{return be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function Cm(r,a,l,h,p,_,w,A,F,X,Q,oe){var fe=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe)}catch(ce){if(ye(fe),!(ce instanceof H))throw ce;xe(1,0)}}function Pm(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Im(r,a,l,h,p,_,w,A,F,X){var Q=ge();try{return be(r)(a,l,h,p,_,w,A,F,X)}catch(oe){if(ye(Q),!(oe instanceof H))throw oe;xe(1,0)}}function Dm(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Lm(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function Fm(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Nm(r,a,l,h,p){var _=ge();try{be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function Um(r,a,l,h){var p=ge();try{be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Om(r,a,l,h,p,_,w,A,F){var X=ge();try{be(r)(a,l,h,p,_,w,A,F)}catch(Q){if(ye(X),!(Q instanceof H))throw Q;xe(1,0)}}function Bm(r,a,l,h,p,_,w,A,F){var X=ge();try{return be(r)(a,l,h,p,_,w,A,F)}catch(Q){if(ye(X),!(Q instanceof H))throw Q;xe(1,0)}}function km(r,a,l,h,p,_,w){var A=ge();try{return be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function zm(r,a,l,h){var p=ge();try{be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Gm(r,a,l,h,p){var _=ge();try{return be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function Vm(r,a,l,h,p){var _=ge();try{return be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function Hm(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Wm(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Xm(r,a){var l=ge();try{return be(r)(a)}catch(h){if(ye(l),!(h instanceof H))throw h;xe(1,0)}}function $m(r,a,l,h,p,_,w,A){var F=ge();try{return be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function qm(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function Ym(r,a,l,h,p,_,w,A,F,X,Q,oe){var fe=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe)}catch(ce){if(ye(fe),!(ce instanceof H))throw ce;xe(1,0)}}function jm(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt,mn){var Dt=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt,mn)}catch(Ji){if(ye(Dt),!(Ji instanceof H))throw Ji;xe(1,0)}}function Zm(r,a,l,h,p,_,w,A,F,X,Q,oe,fe){var ce=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe)}catch(_e){if(ye(ce),!(_e instanceof H))throw _e;xe(1,0)}}function Jm(r,a,l,h,p,_,w,A){var F=ge();try{be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function Km(r,a,l,h,p,_,w,A,F,X,Q,oe,fe){var ce=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe)}catch(_e){if(ye(ce),!(_e instanceof H))throw _e;xe(1,0)}}function Qm(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function eg(r,a,l,h,p,_,w,A,F,X,Q){var oe=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q)}catch(fe){if(ye(oe),!(fe instanceof H))throw fe;xe(1,0)}}function tg(r,a,l,h,p,_,w,A){var F=ge();try{return be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function ng(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function ig(r,a,l){var h=ge();try{be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function rg(r,a,l,h,p,_,w){var A=ge();try{return be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function sg(r,a,l,h,p,_,w,A,F,X){var Q=ge();try{return be(r)(a,l,h,p,_,w,A,F,X)}catch(oe){if(ye(Q),!(oe instanceof H))throw oe;xe(1,0)}}function ag(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function og(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function lg(r,a,l,h,p){var _=ge();try{return be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;return xe(1,0),0n}}function cg(r,a,l,h,p){var _=ge();try{be(r)(a,l,h,p)}catch(w){if(ye(_),!(w instanceof H))throw w;xe(1,0)}}function hg(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function ug(r,a){var l=ge();try{return be(r)(a)}catch(h){if(ye(l),!(h instanceof H))throw h;xe(1,0)}}function dg(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function fg(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function pg(r,a,l,h,p,_,w,A,F,X){var Q=ge();try{return be(r)(a,l,h,p,_,w,A,F,X)}catch(oe){if(ye(Q),!(oe instanceof H))throw oe;xe(1,0)}}function mg(r,a,l,h,p,_,w,A){var F=ge();try{be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function gg(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function _g(r,a,l,h,p,_,w,A){var F=ge();try{be(r)(a,l,h,p,_,w,A)}catch(X){if(ye(F),!(X instanceof H))throw X;xe(1,0)}}function vg(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function yg(r,a,l,h,p,_,w,A,F,X,Q,oe,fe){var ce=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe)}catch(_e){if(ye(ce),!(_e instanceof H))throw _e;xe(1,0)}}function xg(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt,mn,Dt,Ji,Hg,Wg,Xg,$g,qg,Yg,jg,Zg,Jg,Kg,Qg,e_,t_,n_,i_,r_,s_,a_,o_,l_,c_,h_,u_,d_,f_,p_,m_,g_,__,v_,y_,x_,S_,M_,b_,E_,w_,T_,A_,R_,C_,P_,I_,D_,L_,F_,N_,U_,O_,B_,k_,z_,G_,V_,H_,W_,X_,$_,q_,Y_,j_){var Z_=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt,Mt,cn,jt,mn,Dt,Ji,Hg,Wg,Xg,$g,qg,Yg,jg,Zg,Jg,Kg,Qg,e_,t_,n_,i_,r_,s_,a_,o_,l_,c_,h_,u_,d_,f_,p_,m_,g_,__,v_,y_,x_,S_,M_,b_,E_,w_,T_,A_,R_,C_,P_,I_,D_,L_,F_,N_,U_,O_,B_,k_,z_,G_,V_,H_,W_,X_,$_,q_,Y_,j_)}catch(Bh){if(ye(Z_),!(Bh instanceof H))throw Bh;xe(1,0)}}function Sg(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce){var _e=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce)}catch(Je){if(ye(_e),!(Je instanceof H))throw Je;xe(1,0)}}function Mg(r,a,l,h,p,_,w,A,F,X,Q){var oe=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q)}catch(fe){if(ye(oe),!(fe instanceof H))throw fe;xe(1,0)}}function bg(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt){var Mt=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je,vt,pt,Nt)}catch(cn){if(ye(Mt),!(cn instanceof H))throw cn;xe(1,0)}}function Eg(r,a){var l=ge();try{return be(r)(a)}catch(h){if(ye(l),!(h instanceof H))throw h;return xe(1,0),0n}}function wg(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;return xe(1,0),0n}}function Tg(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function Ag(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function Rg(r,a,l,h,p,_,w){var A=ge();try{be(r)(a,l,h,p,_,w)}catch(F){if(ye(A),!(F instanceof H))throw F;xe(1,0)}}function Cg(r,a,l){var h=ge();try{be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function Pg(r,a,l){var h=ge();try{return be(r)(a,l)}catch(p){if(ye(h),!(p instanceof H))throw p;xe(1,0)}}function Ig(r,a,l,h,p,_){var w=ge();try{return be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Dg(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Lg(r,a,l,h){var p=ge();try{be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Fg(r){var a=ge();try{return be(r)()}catch(l){if(ye(a),!(l instanceof H))throw l;return xe(1,0),0n}}function Ng(r,a,l,h,p,_){var w=ge();try{be(r)(a,l,h,p,_)}catch(A){if(ye(w),!(A instanceof H))throw A;xe(1,0)}}function Ug(r,a,l,h,p,_,w,A,F,X,Q){var oe=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q)}catch(fe){if(ye(oe),!(fe instanceof H))throw fe;xe(1,0)}}function Og(r,a,l,h){var p=ge();try{return be(r)(a,l,h)}catch(_){if(ye(p),!(_ instanceof H))throw _;xe(1,0)}}function Bg(r,a,l,h,p,_,w,A,F,X,Q,oe){var fe=ge();try{return be(r)(a,l,h,p,_,w,A,F,X,Q,oe)}catch(ce){if(ye(fe),!(ce instanceof H))throw ce;xe(1,0)}}function kg(r,a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je){var vt=ge();try{be(r)(a,l,h,p,_,w,A,F,X,Q,oe,fe,ce,_e,Je)}catch(pt){if(ye(vt),!(pt instanceof H))throw pt;xe(1,0)}}var Oh;function zg(){Ch(),Se()}function wl(){if(Ze>0){L=wl;return}if(zg(),Le(),Ze>0){L=wl;return}function r(){G(!Oh),Oh=!0,t.calledRun=!0,!z&&(Wt(),Tt?.(t),t.onRuntimeInitialized?.(),Fe("onRuntimeInitialized"),G(!t._main,'compiled without a main, but one is present. if you added it from JS, use Module["onRuntimeInitialized"]'),je())}t.setStatus?(t.setStatus("Running..."),setTimeout(()=>{setTimeout(()=>t.setStatus(""),1),r()},1)):r(),re()}function Gg(){var r=O,a=I,l=!1;O=I=h=>{l=!0};try{Ml(0),["stdout","stderr"].forEach(h=>{var p=M.analyzePath("/dev/"+h);if(p){var _=p.object,w=_.rdev,A=st.ttys[w];A?.output?.length&&(l=!0)}})}catch{}O=r,I=a,l&&jn("stdio streams had content in them that was not flushed. you should set EXIT_RUNTIME to 1 (see the Emscripten FAQ), or make sure to emit a newline when you printf etc.")}function Vg(){if(t.preInit)for(typeof t.preInit=="function"&&(t.preInit=[t.preInit]);t.preInit.length>0;)t.preInit.shift()();Fe("preInit")}Vg(),wl(),At?e=t:e=new Promise((r,a)=>{Tt=r,dt=a});for(let r of Object.keys(t))r in i||Object.defineProperty(i,r,{configurable:!0,get(){pe(`Access to module property ('${r}') is no longer possible via the module constructor argument; Instead, use the result of the module constructor.`)}});return e}),zh=s0;var ki={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},zi={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},mu=0,tc=1,gu=2;var Fs=1,_u=2,zr=3,Gi=0,xn=1,li=2,ir=0,Gr=1,nc=2,ic=3,rc=4,vu=5;var rr=100,yu=101,xu=102,Su=103,Mu=104,bu=200,Eu=201,wu=202,Tu=203,sc=204,ac=205,Au=206,Ru=207,Cu=208,Pu=209,Iu=210,Du=211,Lu=212,Fu=213,Nu=214,Ua=0,Oa=1,Ba=2,Tr=3,ka=4,za=5,Ga=6,Va=7,oc=0,Uu=1,Ou=2,ci=0,lc=1,cc=2,hc=3,uc=4,dc=5,fc=6,pc=7;var mc=300,sr=301,Vr=302,fo=303,po=304,Ar=1e3,ii=1001,Ha=1002,sn=1003,Bu=1004;var Ns=1005;var vn=1006,mo=1007;var Hn=1008;var bn=1009,gc=1010,_c=1011,Hr=1012,go=1013,Wn=1014,Xn=1015,$n=1016,_o=1017,vo=1018,ar=1020,vc=35902,yc=35899,xc=1021,Sc=1022,qn=1023,xi=1026,bi=1027,Mc=1028,yo=1029,Vi=1030,xo=1031;var So=1033,Us=33776,Os=33777,Bs=33778,ks=33779,Mo=35840,bo=35841,Eo=35842,wo=35843,To=36196,Ao=37492,Ro=37496,Co=37488,Po=37489,zs=37490,Io=37491,Do=37808,Lo=37809,Fo=37810,No=37811,Uo=37812,Oo=37813,Bo=37814,ko=37815,zo=37816,Go=37817,Vo=37818,Ho=37819,Wo=37820,Xo=37821,$o=36492,qo=36494,Yo=36495,jo=36283,Zo=36284,Gs=36285,Jo=36286;var os=2300,Wa=2301,Fa=2302,ql=2303,Yl=2400,jl=2401,Zl=2402;var ku=3200;var Ko=0,zu=1,Ei="",dn="srgb",ls="srgb-linear",cs="linear",Rt="srgb";var Na=7680;var Gu=519,Vu=512,Hu=513,Wu=514,bc=515,Xu=516,$u=517,Ec=518,wc=519,qu=35044;var Tc="300 es",Nn=2e3,Rr=2001;function a0(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function o0(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function hs(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function Yu(){let i=hs("canvas");return i.style.display="block",i}var Gh={},Cr=null;function Ac(...i){let e="THREE."+i.shift();Cr?Cr("log",e,...i):console.log(e,...i)}function ju(i){let e=i[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=i[1];t&&t.isStackTrace?i[0]+=" "+t.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function Qe(...i){i=ju(i);let e="THREE."+i.shift();if(Cr)Cr("warn",e,...i);else{let t=i[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...i)}}function tt(...i){i=ju(i);let e="THREE."+i.shift();if(Cr)Cr("error",e,...i);else{let t=i[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...i)}}function rs(...i){let e=i.join(" ");e in Gh||(Gh[e]=!0,Qe(...i))}function Zu(i,e,t){return new Promise(function(n,s){function o(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(o,t);break;default:n()}}setTimeout(o,t)})}var Ju={[Ua]:Ua,[Ba]:Ga,[ka]:ka,[Tr]:za,[Oa]:Oa,[Ga]:Ba,[Va]:Va,[za]:Tr},Vn=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n===void 0?!1:n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let s=n[e];if(s!==void 0){let o=s.indexOf(t);o!==-1&&s.splice(o,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let s=n.slice(0);for(let o=0,c=s.length;o<c;o++)s[o].call(this,e);e.target=null}}},hn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Vh=1234567,ss=Math.PI/180,Pr=180/Math.PI;function Wr(){let i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(hn[i&255]+hn[i>>8&255]+hn[i>>16&255]+hn[i>>24&255]+"-"+hn[e&255]+hn[e>>8&255]+"-"+hn[e>>16&15|64]+hn[e>>24&255]+"-"+hn[t&63|128]+hn[t>>8&255]+"-"+hn[t>>16&255]+hn[t>>24&255]+hn[n&255]+hn[n>>8&255]+hn[n>>16&255]+hn[n>>24&255]).toLowerCase()}function gt(i,e,t){return Math.max(e,Math.min(t,i))}function Rc(i,e){return(i%e+e)%e}function l0(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function c0(i,e,t){return i!==e?(t-i)/(e-i):0}function as(i,e,t){return(1-t)*i+t*e}function h0(i,e,t,n){return as(i,e,1-Math.exp(-t*n))}function u0(i,e=1){return e-Math.abs(Rc(i,e*2)-e)}function d0(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function f0(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function p0(i,e){return i+Math.floor(Math.random()*(e-i+1))}function m0(i,e){return i+Math.random()*(e-i)}function g0(i){return i*(.5-Math.random())}function _0(i){i!==void 0&&(Vh=i);let e=Vh+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function v0(i){return i*ss}function y0(i){return i*Pr}function x0(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function S0(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function Cc(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function M0(i,e,t,n,s){let o=Math.cos,c=Math.sin,u=o(t/2),f=c(t/2),d=o((e+n)/2),m=c((e+n)/2),y=o((e-n)/2),g=c((e-n)/2),S=o((n-e)/2),E=c((n-e)/2);switch(s){case"XYX":i.set(u*m,f*y,f*g,u*d);break;case"YZY":i.set(f*g,u*m,f*y,u*d);break;case"ZXZ":i.set(f*y,f*g,u*m,u*d);break;case"XZX":i.set(u*m,f*E,f*S,u*d);break;case"YXY":i.set(f*S,u*m,f*E,u*d);break;case"ZYZ":i.set(f*E,f*S,u*m,u*d);break;default:Qe("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Pc(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function Ku(i,e){if(e.constructor===Float32Array)return i;let t=Pc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/t,-1)}function Qu(i,e){if(e.constructor===Float32Array)return i;let t=Pc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*t)}var Ic={DEG2RAD:ss,RAD2DEG:Pr,generateUUID:Wr,clamp:gt,euclideanModulo:Rc,mapLinear:l0,inverseLerp:c0,lerp:as,damp:h0,pingpong:u0,smoothstep:d0,smootherstep:f0,randInt:p0,randFloat:m0,randFloatSpread:g0,seededRandom:_0,degToRad:v0,radToDeg:y0,isPowerOfTwo:x0,ceilPowerOfTwo:S0,floorPowerOfTwo:Cc,setQuaternionFromProperEuler:M0,normalize:Qu,denormalize:Ku},et=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(gt(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),s=Math.sin(t),o=this.x-e.x,c=this.y-e.y;return this.x=o*n-c*s+e.x,this.y=o*s+c*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},Rn=class{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=s}static slerpFlat(e,t,n,s,o,c,u){let f=n[s+0],d=n[s+1],m=n[s+2],y=n[s+3],g=o[c+0],S=o[c+1],E=o[c+2],C=o[c+3];if(y!==C||f!==g||d!==S||m!==E){let x=f*g+d*S+m*E+y*C;x<0&&(g=-g,S=-S,E=-E,C=-C,x=-x);let v=1-u;if(x<.9995){let P=Math.acos(x),O=Math.sin(P);v=Math.sin(v*P)/O,u=Math.sin(u*P)/O,f=f*v+g*u,d=d*v+S*u,m=m*v+E*u,y=y*v+C*u}else{f=f*v+g*u,d=d*v+S*u,m=m*v+E*u,y=y*v+C*u;let P=1/Math.sqrt(f*f+d*d+m*m+y*y);f*=P,d*=P,m*=P,y*=P}}e[t]=f,e[t+1]=d,e[t+2]=m,e[t+3]=y}static multiplyQuaternionsFlat(e,t,n,s,o,c){let u=n[s],f=n[s+1],d=n[s+2],m=n[s+3],y=o[c],g=o[c+1],S=o[c+2],E=o[c+3];return e[t]=u*E+m*y+f*S-d*g,e[t+1]=f*E+m*g+d*y-u*S,e[t+2]=d*E+m*S+u*g-f*y,e[t+3]=m*E-u*y-f*g-d*S,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,s){return this._x=e,this._y=t,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,s=e._y,o=e._z,c=e._order,u=Math.cos,f=Math.sin,d=u(n/2),m=u(s/2),y=u(o/2),g=f(n/2),S=f(s/2),E=f(o/2);switch(c){case"XYZ":this._x=g*m*y+d*S*E,this._y=d*S*y-g*m*E,this._z=d*m*E+g*S*y,this._w=d*m*y-g*S*E;break;case"YXZ":this._x=g*m*y+d*S*E,this._y=d*S*y-g*m*E,this._z=d*m*E-g*S*y,this._w=d*m*y+g*S*E;break;case"ZXY":this._x=g*m*y-d*S*E,this._y=d*S*y+g*m*E,this._z=d*m*E+g*S*y,this._w=d*m*y-g*S*E;break;case"ZYX":this._x=g*m*y-d*S*E,this._y=d*S*y+g*m*E,this._z=d*m*E-g*S*y,this._w=d*m*y+g*S*E;break;case"YZX":this._x=g*m*y+d*S*E,this._y=d*S*y+g*m*E,this._z=d*m*E-g*S*y,this._w=d*m*y-g*S*E;break;case"XZY":this._x=g*m*y-d*S*E,this._y=d*S*y-g*m*E,this._z=d*m*E+g*S*y,this._w=d*m*y+g*S*E;break;default:Qe("Quaternion: .setFromEuler() encountered an unknown order: "+c)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,s=Math.sin(n);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],s=t[4],o=t[8],c=t[1],u=t[5],f=t[9],d=t[2],m=t[6],y=t[10],g=n+u+y;if(g>0){let S=.5/Math.sqrt(g+1);this._w=.25/S,this._x=(m-f)*S,this._y=(o-d)*S,this._z=(c-s)*S}else if(n>u&&n>y){let S=2*Math.sqrt(1+n-u-y);this._w=(m-f)/S,this._x=.25*S,this._y=(s+c)/S,this._z=(o+d)/S}else if(u>y){let S=2*Math.sqrt(1+u-n-y);this._w=(o-d)/S,this._x=(s+c)/S,this._y=.25*S,this._z=(f+m)/S}else{let S=2*Math.sqrt(1+y-n-u);this._w=(c-s)/S,this._x=(o+d)/S,this._y=(f+m)/S,this._z=.25*S}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(gt(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,s=e._y,o=e._z,c=e._w,u=t._x,f=t._y,d=t._z,m=t._w;return this._x=n*m+c*u+s*d-o*f,this._y=s*m+c*f+o*u-n*d,this._z=o*m+c*d+n*f-s*u,this._w=c*m-n*u-s*f-o*d,this._onChangeCallback(),this}slerp(e,t){let n=e._x,s=e._y,o=e._z,c=e._w,u=this.dot(e);u<0&&(n=-n,s=-s,o=-o,c=-c,u=-u);let f=1-t;if(u<.9995){let d=Math.acos(u),m=Math.sin(d);f=Math.sin(f*d)/m,t=Math.sin(t*d)/m,this._x=this._x*f+n*t,this._y=this._y*f+s*t,this._z=this._z*f+o*t,this._w=this._w*f+c*t,this._onChangeCallback()}else this._x=this._x*f+n*t,this._y=this._y*f+s*t,this._z=this._z*f+o*t,this._w=this._w*f+c*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),o=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),o*Math.sin(t),o*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},j=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(Hh.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(Hh.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,s=this.z,o=e.elements;return this.x=o[0]*t+o[3]*n+o[6]*s,this.y=o[1]*t+o[4]*n+o[7]*s,this.z=o[2]*t+o[5]*n+o[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,o=e.elements,c=1/(o[3]*t+o[7]*n+o[11]*s+o[15]);return this.x=(o[0]*t+o[4]*n+o[8]*s+o[12])*c,this.y=(o[1]*t+o[5]*n+o[9]*s+o[13])*c,this.z=(o[2]*t+o[6]*n+o[10]*s+o[14])*c,this}applyQuaternion(e){let t=this.x,n=this.y,s=this.z,o=e.x,c=e.y,u=e.z,f=e.w,d=2*(c*s-u*n),m=2*(u*t-o*s),y=2*(o*n-c*t);return this.x=t+f*d+c*y-u*m,this.y=n+f*m+u*d-o*y,this.z=s+f*y+o*m-c*d,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,s=this.z,o=e.elements;return this.x=o[0]*t+o[4]*n+o[8]*s,this.y=o[1]*t+o[5]*n+o[9]*s,this.z=o[2]*t+o[6]*n+o[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this.z=gt(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this.z=gt(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,s=e.y,o=e.z,c=t.x,u=t.y,f=t.z;return this.x=s*f-o*u,this.y=o*c-n*f,this.z=n*u-s*c,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return Tl.copy(this).projectOnVector(e),this.sub(Tl)}reflect(e){return this.sub(Tl.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(gt(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Tl=new j,Hh=new Rn,at=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,s,o,c,u,f,d){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,o,c,u,f,d)}set(e,t,n,s,o,c,u,f,d){let m=this.elements;return m[0]=e,m[1]=s,m[2]=u,m[3]=t,m[4]=o,m[5]=f,m[6]=n,m[7]=c,m[8]=d,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,o=this.elements,c=n[0],u=n[3],f=n[6],d=n[1],m=n[4],y=n[7],g=n[2],S=n[5],E=n[8],C=s[0],x=s[3],v=s[6],P=s[1],O=s[4],I=s[7],U=s[2],N=s[5],b=s[8];return o[0]=c*C+u*P+f*U,o[3]=c*x+u*O+f*N,o[6]=c*v+u*I+f*b,o[1]=d*C+m*P+y*U,o[4]=d*x+m*O+y*N,o[7]=d*v+m*I+y*b,o[2]=g*C+S*P+E*U,o[5]=g*x+S*O+E*N,o[8]=g*v+S*I+E*b,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],s=e[2],o=e[3],c=e[4],u=e[5],f=e[6],d=e[7],m=e[8];return t*c*m-t*u*d-n*o*m+n*u*f+s*o*d-s*c*f}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],o=e[3],c=e[4],u=e[5],f=e[6],d=e[7],m=e[8],y=m*c-u*d,g=u*f-m*o,S=d*o-c*f,E=t*y+n*g+s*S;if(E===0)return this.set(0,0,0,0,0,0,0,0,0);let C=1/E;return e[0]=y*C,e[1]=(s*d-m*n)*C,e[2]=(u*n-s*c)*C,e[3]=g*C,e[4]=(m*t-s*f)*C,e[5]=(s*o-u*t)*C,e[6]=S*C,e[7]=(n*f-d*t)*C,e[8]=(c*t-n*o)*C,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,o,c,u){let f=Math.cos(o),d=Math.sin(o);return this.set(n*f,n*d,-n*(f*c+d*u)+c+e,-s*d,s*f,-s*(-d*c+f*u)+u+t,0,0,1),this}scale(e,t){return rs("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Al.makeScale(e,t)),this}rotate(e){return rs("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Al.makeRotation(-e)),this}translate(e,t){return rs("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Al.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},Al=new at,Wh=new at().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Xh=new at().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function b0(){let i={enabled:!0,workingColorSpace:ls,spaces:{},convert:function(s,o,c){return this.enabled===!1||o===c||!o||!c||(this.spaces[o].transfer===Rt&&(s.r=yi(s.r),s.g=yi(s.g),s.b=yi(s.b)),this.spaces[o].primaries!==this.spaces[c].primaries&&(s.applyMatrix3(this.spaces[o].toXYZ),s.applyMatrix3(this.spaces[c].fromXYZ)),this.spaces[c].transfer===Rt&&(s.r=wr(s.r),s.g=wr(s.g),s.b=wr(s.b))),s},workingToColorSpace:function(s,o){return this.convert(s,this.workingColorSpace,o)},colorSpaceToWorking:function(s,o){return this.convert(s,o,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===Ei?cs:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,o=this.workingColorSpace){return s.fromArray(this.spaces[o].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,o,c){return s.copy(this.spaces[c].fromXYZ).multiply(this.spaces[o].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[ls]:{primaries:e,whitePoint:n,transfer:cs,toXYZ:Wh,fromXYZ:Xh,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:dn},outputColorSpaceConfig:{drawingBufferColorSpace:dn}},[dn]:{primaries:e,whitePoint:n,transfer:Rt,toXYZ:Wh,fromXYZ:Xh,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:dn}}}),i}var yt=b0();function yi(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function wr(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var dr,Xa=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{dr===void 0&&(dr=hs("canvas")),dr.width=e.width,dr.height=e.height;let s=dr.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),n=dr}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=hs("canvas");t.width=e.width,t.height=e.height;let n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);let s=n.getImageData(0,0,e.width,e.height),o=s.data;for(let c=0;c<o.length;c++)o[c]=yi(o[c]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(yi(t[n]/255)*255):t[n]=yi(t[n]);return{data:t,width:e.width,height:e.height}}else return Qe("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},E0=0,Ir=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:E0++}),this.uuid=Wr(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let o;if(Array.isArray(s)){o=[];for(let c=0,u=s.length;c<u;c++)s[c].isDataTexture?o.push(Rl(s[c].image)):o.push(Rl(s[c]))}else o=Rl(s);n.url=o}return t||(e.images[this.uuid]=n),n}};function Rl(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Xa.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(Qe("Texture: Unable to serialize Texture."),{})}var w0=0,Cl=new j,Sn=class i extends Vn{constructor(e=i.DEFAULT_IMAGE,t=i.DEFAULT_MAPPING,n=ii,s=ii,o=vn,c=Hn,u=qn,f=bn,d=i.DEFAULT_ANISOTROPY,m=Ei){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:w0++}),this.uuid=Wr(),this.name="",this.source=new Ir(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=o,this.minFilter=c,this.anisotropy=d,this.format=u,this.internalFormat=null,this.type=f,this.offset=new et(0,0),this.repeat=new et(1,1),this.center=new et(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new at,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=m,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Cl).x}get height(){return this.source.getSize(Cl).y}get depth(){return this.source.getSize(Cl).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){Qe(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Qe(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==mc)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Ar:e.x=e.x-Math.floor(e.x);break;case ii:e.x=e.x<0?0:1;break;case Ha:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Ar:e.y=e.y-Math.floor(e.y);break;case ii:e.y=e.y<0?0:1;break;case Ha:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};Sn.DEFAULT_IMAGE=null;Sn.DEFAULT_MAPPING=mc;Sn.DEFAULT_ANISOTROPY=1;var zt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,s=1){this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,o=this.w,c=e.elements;return this.x=c[0]*t+c[4]*n+c[8]*s+c[12]*o,this.y=c[1]*t+c[5]*n+c[9]*s+c[13]*o,this.z=c[2]*t+c[6]*n+c[10]*s+c[14]*o,this.w=c[3]*t+c[7]*n+c[11]*s+c[15]*o,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,o,f=e.elements,d=f[0],m=f[4],y=f[8],g=f[1],S=f[5],E=f[9],C=f[2],x=f[6],v=f[10];if(Math.abs(m-g)<.01&&Math.abs(y-C)<.01&&Math.abs(E-x)<.01){if(Math.abs(m+g)<.1&&Math.abs(y+C)<.1&&Math.abs(E+x)<.1&&Math.abs(d+S+v-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let O=(d+1)/2,I=(S+1)/2,U=(v+1)/2,N=(m+g)/4,b=(y+C)/4,D=(E+x)/4;return O>I&&O>U?O<.01?(n=0,s=.707106781,o=.707106781):(n=Math.sqrt(O),s=N/n,o=b/n):I>U?I<.01?(n=.707106781,s=0,o=.707106781):(s=Math.sqrt(I),n=N/s,o=D/s):U<.01?(n=.707106781,s=.707106781,o=0):(o=Math.sqrt(U),n=b/o,s=D/o),this.set(n,s,o,t),this}let P=Math.sqrt((x-E)*(x-E)+(y-C)*(y-C)+(g-m)*(g-m));return Math.abs(P)<.001&&(P=1),this.x=(x-E)/P,this.y=(y-C)/P,this.z=(g-m)/P,this.w=Math.acos((d+S+v-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=gt(this.x,e.x,t.x),this.y=gt(this.y,e.y,t.y),this.z=gt(this.z,e.z,t.z),this.w=gt(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=gt(this.x,e,t),this.y=gt(this.y,e,t),this.z=gt(this.z,e,t),this.w=gt(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(gt(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},$a=class extends Vn{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:vn,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new zt(0,0,e,t),this.scissorTest=!1,this.viewport=new zt(0,0,e,t),this.textures=[];let s=n.count;for(let o=0;o<s;o++)this.textures[o]=new Sn({width:e,height:t,depth:n.depth}),this.textures[o].isRenderTargetTexture=!0,this.textures[o].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:vn,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,o=this.textures.length;s<o;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new Ir(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},Cn=class extends $a{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},us=class extends Sn{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=sn,this.minFilter=sn,this.wrapR=ii,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var qa=class extends Sn{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=sn,this.minFilter=sn,this.wrapR=ii,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var Lt=class i{static{this.prototype.isMatrix4=!0}constructor(e,t,n,s,o,c,u,f,d,m,y,g,S,E,C,x){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,o,c,u,f,d,m,y,g,S,E,C,x)}set(e,t,n,s,o,c,u,f,d,m,y,g,S,E,C,x){let v=this.elements;return v[0]=e,v[4]=t,v[8]=n,v[12]=s,v[1]=o,v[5]=c,v[9]=u,v[13]=f,v[2]=d,v[6]=m,v[10]=y,v[14]=g,v[3]=S,v[7]=E,v[11]=C,v[15]=x,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,s=1/fr.setFromMatrixColumn(e,0).length(),o=1/fr.setFromMatrixColumn(e,1).length(),c=1/fr.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*o,t[5]=n[5]*o,t[6]=n[6]*o,t[7]=0,t[8]=n[8]*c,t[9]=n[9]*c,t[10]=n[10]*c,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,s=e.y,o=e.z,c=Math.cos(n),u=Math.sin(n),f=Math.cos(s),d=Math.sin(s),m=Math.cos(o),y=Math.sin(o);if(e.order==="XYZ"){let g=c*m,S=c*y,E=u*m,C=u*y;t[0]=f*m,t[4]=-f*y,t[8]=d,t[1]=S+E*d,t[5]=g-C*d,t[9]=-u*f,t[2]=C-g*d,t[6]=E+S*d,t[10]=c*f}else if(e.order==="YXZ"){let g=f*m,S=f*y,E=d*m,C=d*y;t[0]=g+C*u,t[4]=E*u-S,t[8]=c*d,t[1]=c*y,t[5]=c*m,t[9]=-u,t[2]=S*u-E,t[6]=C+g*u,t[10]=c*f}else if(e.order==="ZXY"){let g=f*m,S=f*y,E=d*m,C=d*y;t[0]=g-C*u,t[4]=-c*y,t[8]=E+S*u,t[1]=S+E*u,t[5]=c*m,t[9]=C-g*u,t[2]=-c*d,t[6]=u,t[10]=c*f}else if(e.order==="ZYX"){let g=c*m,S=c*y,E=u*m,C=u*y;t[0]=f*m,t[4]=E*d-S,t[8]=g*d+C,t[1]=f*y,t[5]=C*d+g,t[9]=S*d-E,t[2]=-d,t[6]=u*f,t[10]=c*f}else if(e.order==="YZX"){let g=c*f,S=c*d,E=u*f,C=u*d;t[0]=f*m,t[4]=C-g*y,t[8]=E*y+S,t[1]=y,t[5]=c*m,t[9]=-u*m,t[2]=-d*m,t[6]=S*y+E,t[10]=g-C*y}else if(e.order==="XZY"){let g=c*f,S=c*d,E=u*f,C=u*d;t[0]=f*m,t[4]=-y,t[8]=d*m,t[1]=g*y+C,t[5]=c*m,t[9]=S*y-E,t[2]=E*y-S,t[6]=u*m,t[10]=C*y+g}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(T0,e,A0)}lookAt(e,t,n){let s=this.elements;return Tn.subVectors(e,t),Tn.lengthSq()===0&&(Tn.z=1),Tn.normalize(),Ti.crossVectors(n,Tn),Ti.lengthSq()===0&&(Math.abs(n.z)===1?Tn.x+=1e-4:Tn.z+=1e-4,Tn.normalize(),Ti.crossVectors(n,Tn)),Ti.normalize(),da.crossVectors(Tn,Ti),s[0]=Ti.x,s[4]=da.x,s[8]=Tn.x,s[1]=Ti.y,s[5]=da.y,s[9]=Tn.y,s[2]=Ti.z,s[6]=da.z,s[10]=Tn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,o=this.elements,c=n[0],u=n[4],f=n[8],d=n[12],m=n[1],y=n[5],g=n[9],S=n[13],E=n[2],C=n[6],x=n[10],v=n[14],P=n[3],O=n[7],I=n[11],U=n[15],N=s[0],b=s[4],D=s[8],q=s[12],k=s[1],Y=s[5],J=s[9],ee=s[13],z=s[2],ie=s[6],G=s[10],ne=s[14],Se=s[3],re=s[7],H=s[11],me=s[15];return o[0]=c*N+u*k+f*z+d*Se,o[4]=c*b+u*Y+f*ie+d*re,o[8]=c*D+u*J+f*G+d*H,o[12]=c*q+u*ee+f*ne+d*me,o[1]=m*N+y*k+g*z+S*Se,o[5]=m*b+y*Y+g*ie+S*re,o[9]=m*D+y*J+g*G+S*H,o[13]=m*q+y*ee+g*ne+S*me,o[2]=E*N+C*k+x*z+v*Se,o[6]=E*b+C*Y+x*ie+v*re,o[10]=E*D+C*J+x*G+v*H,o[14]=E*q+C*ee+x*ne+v*me,o[3]=P*N+O*k+I*z+U*Se,o[7]=P*b+O*Y+I*ie+U*re,o[11]=P*D+O*J+I*G+U*H,o[15]=P*q+O*ee+I*ne+U*me,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],s=e[8],o=e[12],c=e[1],u=e[5],f=e[9],d=e[13],m=e[2],y=e[6],g=e[10],S=e[14],E=e[3],C=e[7],x=e[11],v=e[15],P=f*S-d*g,O=u*S-d*y,I=u*g-f*y,U=c*S-d*m,N=c*g-f*m,b=c*y-u*m;return t*(C*P-x*O+v*I)-n*(E*P-x*U+v*N)+s*(E*O-C*U+v*b)-o*(E*I-C*N+x*b)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],s=e[8],o=e[1],c=e[5],u=e[9],f=e[2],d=e[6],m=e[10];return t*(c*m-u*d)-n*(o*m-u*f)+s*(o*d-c*f)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],o=e[3],c=e[4],u=e[5],f=e[6],d=e[7],m=e[8],y=e[9],g=e[10],S=e[11],E=e[12],C=e[13],x=e[14],v=e[15],P=t*u-n*c,O=t*f-s*c,I=t*d-o*c,U=n*f-s*u,N=n*d-o*u,b=s*d-o*f,D=m*C-y*E,q=m*x-g*E,k=m*v-S*E,Y=y*x-g*C,J=y*v-S*C,ee=g*v-S*x,z=P*ee-O*J+I*Y+U*k-N*q+b*D;if(z===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let ie=1/z;return e[0]=(u*ee-f*J+d*Y)*ie,e[1]=(s*J-n*ee-o*Y)*ie,e[2]=(C*b-x*N+v*U)*ie,e[3]=(g*N-y*b-S*U)*ie,e[4]=(f*k-c*ee-d*q)*ie,e[5]=(t*ee-s*k+o*q)*ie,e[6]=(x*I-E*b-v*O)*ie,e[7]=(m*b-g*I+S*O)*ie,e[8]=(c*J-u*k+d*D)*ie,e[9]=(n*k-t*J-o*D)*ie,e[10]=(E*N-C*I+v*P)*ie,e[11]=(y*I-m*N-S*P)*ie,e[12]=(u*q-c*Y-f*D)*ie,e[13]=(t*Y-n*q+s*D)*ie,e[14]=(C*O-E*U-x*P)*ie,e[15]=(m*U-y*O+g*P)*ie,this}scale(e){let t=this.elements,n=e.x,s=e.y,o=e.z;return t[0]*=n,t[4]*=s,t[8]*=o,t[1]*=n,t[5]*=s,t[9]*=o,t[2]*=n,t[6]*=s,t[10]*=o,t[3]*=n,t[7]*=s,t[11]*=o,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),s=Math.sin(t),o=1-n,c=e.x,u=e.y,f=e.z,d=o*c,m=o*u;return this.set(d*c+n,d*u-s*f,d*f+s*u,0,d*u+s*f,m*u+n,m*f-s*c,0,d*f-s*u,m*f+s*c,o*f*f+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,o,c){return this.set(1,n,o,0,e,1,c,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){let s=this.elements,o=t._x,c=t._y,u=t._z,f=t._w,d=o+o,m=c+c,y=u+u,g=o*d,S=o*m,E=o*y,C=c*m,x=c*y,v=u*y,P=f*d,O=f*m,I=f*y,U=n.x,N=n.y,b=n.z;return s[0]=(1-(C+v))*U,s[1]=(S+I)*U,s[2]=(E-O)*U,s[3]=0,s[4]=(S-I)*N,s[5]=(1-(g+v))*N,s[6]=(x+P)*N,s[7]=0,s[8]=(E+O)*b,s[9]=(x-P)*b,s[10]=(1-(g+C))*b,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let o=this.determinantAffine();if(o===0)return n.set(1,1,1),t.identity(),this;let c=fr.set(s[0],s[1],s[2]).length(),u=fr.set(s[4],s[5],s[6]).length(),f=fr.set(s[8],s[9],s[10]).length();o<0&&(c=-c),kn.copy(this);let d=1/c,m=1/u,y=1/f;return kn.elements[0]*=d,kn.elements[1]*=d,kn.elements[2]*=d,kn.elements[4]*=m,kn.elements[5]*=m,kn.elements[6]*=m,kn.elements[8]*=y,kn.elements[9]*=y,kn.elements[10]*=y,t.setFromRotationMatrix(kn),n.x=c,n.y=u,n.z=f,this}makePerspective(e,t,n,s,o,c,u=Nn,f=!1){let d=this.elements,m=2*o/(t-e),y=2*o/(n-s),g=(t+e)/(t-e),S=(n+s)/(n-s),E,C;if(f)E=o/(c-o),C=c*o/(c-o);else if(u===Nn)E=-(c+o)/(c-o),C=-2*c*o/(c-o);else if(u===Rr)E=-c/(c-o),C=-c*o/(c-o);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+u);return d[0]=m,d[4]=0,d[8]=g,d[12]=0,d[1]=0,d[5]=y,d[9]=S,d[13]=0,d[2]=0,d[6]=0,d[10]=E,d[14]=C,d[3]=0,d[7]=0,d[11]=-1,d[15]=0,this}makeOrthographic(e,t,n,s,o,c,u=Nn,f=!1){let d=this.elements,m=2/(t-e),y=2/(n-s),g=-(t+e)/(t-e),S=-(n+s)/(n-s),E,C;if(f)E=1/(c-o),C=c/(c-o);else if(u===Nn)E=-2/(c-o),C=-(c+o)/(c-o);else if(u===Rr)E=-1/(c-o),C=-o/(c-o);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+u);return d[0]=m,d[4]=0,d[8]=0,d[12]=g,d[1]=0,d[5]=y,d[9]=0,d[13]=S,d[2]=0,d[6]=0,d[10]=E,d[14]=C,d[3]=0,d[7]=0,d[11]=0,d[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},fr=new j,kn=new Lt,T0=new j(0,0,0),A0=new j(1,1,1),Ti=new j,da=new j,Tn=new j,$h=new Lt,qh=new Rn,Si=class i{constructor(e=0,t=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=n,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,s=this._order){return this._x=e,this._y=t,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let s=e.elements,o=s[0],c=s[4],u=s[8],f=s[1],d=s[5],m=s[9],y=s[2],g=s[6],S=s[10];switch(t){case"XYZ":this._y=Math.asin(gt(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(-m,S),this._z=Math.atan2(-c,o)):(this._x=Math.atan2(g,d),this._z=0);break;case"YXZ":this._x=Math.asin(-gt(m,-1,1)),Math.abs(m)<.9999999?(this._y=Math.atan2(u,S),this._z=Math.atan2(f,d)):(this._y=Math.atan2(-y,o),this._z=0);break;case"ZXY":this._x=Math.asin(gt(g,-1,1)),Math.abs(g)<.9999999?(this._y=Math.atan2(-y,S),this._z=Math.atan2(-c,d)):(this._y=0,this._z=Math.atan2(f,o));break;case"ZYX":this._y=Math.asin(-gt(y,-1,1)),Math.abs(y)<.9999999?(this._x=Math.atan2(g,S),this._z=Math.atan2(f,o)):(this._x=0,this._z=Math.atan2(-c,d));break;case"YZX":this._z=Math.asin(gt(f,-1,1)),Math.abs(f)<.9999999?(this._x=Math.atan2(-m,d),this._y=Math.atan2(-y,o)):(this._x=0,this._y=Math.atan2(u,S));break;case"XZY":this._z=Math.asin(-gt(c,-1,1)),Math.abs(c)<.9999999?(this._x=Math.atan2(g,d),this._y=Math.atan2(u,o)):(this._x=Math.atan2(-m,S),this._y=0);break;default:Qe("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return $h.makeRotationFromQuaternion(e),this.setFromRotationMatrix($h,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return qh.setFromEuler(this),this.setFromQuaternion(qh,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Si.DEFAULT_ORDER="XYZ";var Dr=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},R0=0,Yh=new j,pr=new Rn,pi=new Lt,fa=new j,Qr=new j,C0=new j,P0=new Rn,jh=new j(1,0,0),Zh=new j(0,1,0),Jh=new j(0,0,1),Kh={type:"added"},I0={type:"removed"},mr={type:"childadded",child:null},Pl={type:"childremoved",child:null},ln=class i extends Vn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:R0++}),this.uuid=Wr(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let e=new j,t=new Si,n=new Rn,s=new j(1,1,1);function o(){n.setFromEuler(t,!1)}function c(){t.setFromQuaternion(n,void 0,!1)}t._onChange(o),n._onChange(c),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Lt},normalMatrix:{value:new at}}),this.matrix=new Lt,this.matrixWorld=new Lt,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Dr,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return pr.setFromAxisAngle(e,t),this.quaternion.multiply(pr),this}rotateOnWorldAxis(e,t){return pr.setFromAxisAngle(e,t),this.quaternion.premultiply(pr),this}rotateX(e){return this.rotateOnAxis(jh,e)}rotateY(e){return this.rotateOnAxis(Zh,e)}rotateZ(e){return this.rotateOnAxis(Jh,e)}translateOnAxis(e,t){return Yh.copy(e).applyQuaternion(this.quaternion),this.position.add(Yh.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(jh,e)}translateY(e){return this.translateOnAxis(Zh,e)}translateZ(e){return this.translateOnAxis(Jh,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(pi.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?fa.copy(e):fa.set(e,t,n);let s=this.parent;this.updateWorldMatrix(!0,!1),Qr.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?pi.lookAt(Qr,fa,this.up):pi.lookAt(fa,Qr,this.up),this.quaternion.setFromRotationMatrix(pi),s&&(pi.extractRotation(s.matrixWorld),pr.setFromRotationMatrix(pi),this.quaternion.premultiply(pr.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(tt("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(Kh),mr.child=e,this.dispatchEvent(mr),mr.child=null):tt("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(I0),Pl.child=e,this.dispatchEvent(Pl),Pl.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),pi.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),pi.multiply(e.parent.matrixWorld)),e.applyMatrix4(pi),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(Kh),mr.child=e,this.dispatchEvent(mr),mr.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){let c=this.children[n].getObjectByProperty(e,t);if(c!==void 0)return c}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let s=this.children;for(let o=0,c=s.length;o<c;o++)s[o].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Qr,e,C0),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Qr,P0,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,s=e.z,o=this.matrix.elements;o[12]+=t-o[0]*t-o[4]*n-o[8]*s,o[13]+=n-o[1]*t-o[5]*n-o[9]*s,o[14]+=s-o[2]*t-o[6]*n-o[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let o=this.children;for(let c=0,u=o.length;c<u;c++)o[c].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(u=>({...u,boundingBox:u.boundingBox?u.boundingBox.toJSON():void 0,boundingSphere:u.boundingSphere?u.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(u=>({...u})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function o(u,f){return u[f.uuid]===void 0&&(u[f.uuid]=f.toJSON(e)),f.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=o(e.geometries,this.geometry);let u=this.geometry.parameters;if(u!==void 0&&u.shapes!==void 0){let f=u.shapes;if(Array.isArray(f))for(let d=0,m=f.length;d<m;d++){let y=f[d];o(e.shapes,y)}else o(e.shapes,f)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(o(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let u=[];for(let f=0,d=this.material.length;f<d;f++)u.push(o(e.materials,this.material[f]));s.material=u}else s.material=o(e.materials,this.material);if(this.children.length>0){s.children=[];for(let u=0;u<this.children.length;u++)s.children.push(this.children[u].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let u=0;u<this.animations.length;u++){let f=this.animations[u];s.animations.push(o(e.animations,f))}}if(t){let u=c(e.geometries),f=c(e.materials),d=c(e.textures),m=c(e.images),y=c(e.shapes),g=c(e.skeletons),S=c(e.animations),E=c(e.nodes);u.length>0&&(n.geometries=u),f.length>0&&(n.materials=f),d.length>0&&(n.textures=d),m.length>0&&(n.images=m),y.length>0&&(n.shapes=y),g.length>0&&(n.skeletons=g),S.length>0&&(n.animations=S),E.length>0&&(n.nodes=E)}return n.object=s,n;function c(u){let f=[];for(let d in u){let m=u[d];delete m.metadata,f.push(m)}return f}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){let s=e.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};ln.DEFAULT_UP=new j(0,1,0);ln.DEFAULT_MATRIX_AUTO_UPDATE=!0;ln.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var ri=class extends ln{constructor(){super(),this.isGroup=!0,this.type="Group"}},D0={type:"move"},Lr=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new ri,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new ri,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new j,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new j),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new ri,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new j,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new j,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let s=null,o=null,c=null,u=this._targetRay,f=this._grip,d=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(d&&e.hand){c=!0;for(let C of e.hand.values()){let x=t.getJointPose(C,n),v=this._getHandJoint(d,C);x!==null&&(v.matrix.fromArray(x.transform.matrix),v.matrix.decompose(v.position,v.quaternion,v.scale),v.matrixWorldNeedsUpdate=!0,v.jointRadius=x.radius),v.visible=x!==null}let m=d.joints["index-finger-tip"],y=d.joints["thumb-tip"],g=m.position.distanceTo(y.position),S=.02,E=.005;d.inputState.pinching&&g>S+E?(d.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!d.inputState.pinching&&g<=S-E&&(d.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else f!==null&&e.gripSpace&&(o=t.getPose(e.gripSpace,n),o!==null&&(f.matrix.fromArray(o.transform.matrix),f.matrix.decompose(f.position,f.quaternion,f.scale),f.matrixWorldNeedsUpdate=!0,o.linearVelocity?(f.hasLinearVelocity=!0,f.linearVelocity.copy(o.linearVelocity)):f.hasLinearVelocity=!1,o.angularVelocity?(f.hasAngularVelocity=!0,f.angularVelocity.copy(o.angularVelocity)):f.hasAngularVelocity=!1,f.eventsEnabled&&f.dispatchEvent({type:"gripUpdated",data:e,target:this})));u!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&o!==null&&(s=o),s!==null&&(u.matrix.fromArray(s.transform.matrix),u.matrix.decompose(u.position,u.quaternion,u.scale),u.matrixWorldNeedsUpdate=!0,s.linearVelocity?(u.hasLinearVelocity=!0,u.linearVelocity.copy(s.linearVelocity)):u.hasLinearVelocity=!1,s.angularVelocity?(u.hasAngularVelocity=!0,u.angularVelocity.copy(s.angularVelocity)):u.hasAngularVelocity=!1,this.dispatchEvent(D0)))}return u!==null&&(u.visible=s!==null),f!==null&&(f.visible=o!==null),d!==null&&(d.visible=c!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new ri;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},ed={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},Ai={h:0,s:0,l:0},pa={h:0,s:0,l:0};function Il(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}var ct=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=dn){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,yt.colorSpaceToWorking(this,t),this}setRGB(e,t,n,s=yt.workingColorSpace){return this.r=e,this.g=t,this.b=n,yt.colorSpaceToWorking(this,s),this}setHSL(e,t,n,s=yt.workingColorSpace){if(e=Rc(e,1),t=gt(t,0,1),n=gt(n,0,1),t===0)this.r=this.g=this.b=n;else{let o=n<=.5?n*(1+t):n+t-n*t,c=2*n-o;this.r=Il(c,o,e+1/3),this.g=Il(c,o,e),this.b=Il(c,o,e-1/3)}return yt.colorSpaceToWorking(this,s),this}setStyle(e,t=dn){function n(o){o!==void 0&&parseFloat(o)<1&&Qe("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let o,c=s[1],u=s[2];switch(c){case"rgb":case"rgba":if(o=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(u))return n(o[4]),this.setRGB(Math.min(255,parseInt(o[1],10))/255,Math.min(255,parseInt(o[2],10))/255,Math.min(255,parseInt(o[3],10))/255,t);if(o=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(u))return n(o[4]),this.setRGB(Math.min(100,parseFloat(o[1]))/100,Math.min(100,parseFloat(o[2]))/100,Math.min(100,parseFloat(o[3]))/100,t);break;case"hsl":case"hsla":if(o=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(u))return n(o[4]),this.setHSL(parseFloat(o[1])/360,parseFloat(o[2])/100,parseFloat(o[3])/100,t);break;default:Qe("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let o=s[1],c=o.length;if(c===3)return this.setRGB(parseInt(o.charAt(0),16)/15,parseInt(o.charAt(1),16)/15,parseInt(o.charAt(2),16)/15,t);if(c===6)return this.setHex(parseInt(o,16),t);Qe("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=dn){let n=ed[e.toLowerCase()];return n!==void 0?this.setHex(n,t):Qe("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=yi(e.r),this.g=yi(e.g),this.b=yi(e.b),this}copyLinearToSRGB(e){return this.r=wr(e.r),this.g=wr(e.g),this.b=wr(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=dn){return yt.workingToColorSpace(un.copy(this),e),Math.round(gt(un.r*255,0,255))*65536+Math.round(gt(un.g*255,0,255))*256+Math.round(gt(un.b*255,0,255))}getHexString(e=dn){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=yt.workingColorSpace){yt.workingToColorSpace(un.copy(this),t);let n=un.r,s=un.g,o=un.b,c=Math.max(n,s,o),u=Math.min(n,s,o),f,d,m=(u+c)/2;if(u===c)f=0,d=0;else{let y=c-u;switch(d=m<=.5?y/(c+u):y/(2-c-u),c){case n:f=(s-o)/y+(s<o?6:0);break;case s:f=(o-n)/y+2;break;case o:f=(n-s)/y+4;break}f/=6}return e.h=f,e.s=d,e.l=m,e}getRGB(e,t=yt.workingColorSpace){return yt.workingToColorSpace(un.copy(this),t),e.r=un.r,e.g=un.g,e.b=un.b,e}getStyle(e=dn){yt.workingToColorSpace(un.copy(this),e);let t=un.r,n=un.g,s=un.b;return e!==dn?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(Ai),this.setHSL(Ai.h+e,Ai.s+t,Ai.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(Ai),e.getHSL(pa);let n=as(Ai.h,pa.h,t),s=as(Ai.s,pa.s,t),o=as(Ai.l,pa.l,t);return this.setHSL(n,s,o),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,s=this.b,o=e.elements;return this.r=o[0]*t+o[3]*n+o[6]*s,this.g=o[1]*t+o[4]*n+o[7]*s,this.b=o[2]*t+o[5]*n+o[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},un=new ct;ct.NAMES=ed;var ds=class i{constructor(e,t=1,n=1e3){this.isFog=!0,this.name="",this.color=new ct(e),this.near=t,this.far=n}clone(){return new i(this.color,this.near,this.far)}toJSON(){return{type:"Fog",name:this.name,color:this.color.getHex(),near:this.near,far:this.far}}},fs=class extends ln{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Si,this.environmentIntensity=1,this.environmentRotation=new Si,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},zn=new j,mi=new j,Dl=new j,gi=new j,gr=new j,_r=new j,Qh=new j,Ll=new j,Fl=new j,Nl=new j,Ul=new zt,Ol=new zt,Bl=new zt,Ii=class i{constructor(e=new j,t=new j,n=new j){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),zn.subVectors(e,t),s.cross(zn);let o=s.lengthSq();return o>0?s.multiplyScalar(1/Math.sqrt(o)):s.set(0,0,0)}static getBarycoord(e,t,n,s,o){zn.subVectors(s,t),mi.subVectors(n,t),Dl.subVectors(e,t);let c=zn.dot(zn),u=zn.dot(mi),f=zn.dot(Dl),d=mi.dot(mi),m=mi.dot(Dl),y=c*d-u*u;if(y===0)return o.set(0,0,0),null;let g=1/y,S=(d*f-u*m)*g,E=(c*m-u*f)*g;return o.set(1-S-E,E,S)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,gi)===null?!1:gi.x>=0&&gi.y>=0&&gi.x+gi.y<=1}static getInterpolation(e,t,n,s,o,c,u,f){return this.getBarycoord(e,t,n,s,gi)===null?(f.x=0,f.y=0,"z"in f&&(f.z=0),"w"in f&&(f.w=0),null):(f.setScalar(0),f.addScaledVector(o,gi.x),f.addScaledVector(c,gi.y),f.addScaledVector(u,gi.z),f)}static getInterpolatedAttribute(e,t,n,s,o,c){return Ul.setScalar(0),Ol.setScalar(0),Bl.setScalar(0),Ul.fromBufferAttribute(e,t),Ol.fromBufferAttribute(e,n),Bl.fromBufferAttribute(e,s),c.setScalar(0),c.addScaledVector(Ul,o.x),c.addScaledVector(Ol,o.y),c.addScaledVector(Bl,o.z),c}static isFrontFacing(e,t,n,s){return zn.subVectors(n,t),mi.subVectors(e,t),zn.cross(mi).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return zn.subVectors(this.c,this.b),mi.subVectors(this.a,this.b),zn.cross(mi).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return i.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return i.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,o){return i.getInterpolation(e,this.a,this.b,this.c,t,n,s,o)}containsPoint(e){return i.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return i.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,s=this.b,o=this.c,c,u;gr.subVectors(s,n),_r.subVectors(o,n),Ll.subVectors(e,n);let f=gr.dot(Ll),d=_r.dot(Ll);if(f<=0&&d<=0)return t.copy(n);Fl.subVectors(e,s);let m=gr.dot(Fl),y=_r.dot(Fl);if(m>=0&&y<=m)return t.copy(s);let g=f*y-m*d;if(g<=0&&f>=0&&m<=0&&f-m>0)return c=f/(f-m),t.copy(n).addScaledVector(gr,c);Nl.subVectors(e,o);let S=gr.dot(Nl),E=_r.dot(Nl);if(E>=0&&S<=E)return t.copy(o);let C=S*d-f*E;if(C<=0&&d>=0&&E<=0)return u=d/(d-E),t.copy(n).addScaledVector(_r,u);let x=m*E-S*y;if(x<=0&&y-m>=0&&S-E>=0)return Qh.subVectors(o,s),u=(y-m)/(y-m+(S-E)),t.copy(s).addScaledVector(Qh,u);let v=1/(x+C+g);return c=C*v,u=g*v,t.copy(n).addScaledVector(gr,c).addScaledVector(_r,u)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},Di=class{constructor(e=new j(1/0,1/0,1/0),t=new j(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Gn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Gn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Gn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let o=n.getAttribute("position");if(t===!0&&o!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let c=0,u=o.count;c<u;c++)e.isMesh===!0?e.getVertexPosition(c,Gn):Gn.fromBufferAttribute(o,c),Gn.applyMatrix4(e.matrixWorld),this.expandByPoint(Gn);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),ma.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),ma.copy(n.boundingBox)),ma.applyMatrix4(e.matrixWorld),this.union(ma)}let s=e.children;for(let o=0,c=s.length;o<c;o++)this.expandByObject(s[o],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Gn),Gn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(es),ga.subVectors(this.max,es),vr.subVectors(e.a,es),yr.subVectors(e.b,es),xr.subVectors(e.c,es),Ri.subVectors(yr,vr),Ci.subVectors(xr,yr),Ki.subVectors(vr,xr);let t=[0,-Ri.z,Ri.y,0,-Ci.z,Ci.y,0,-Ki.z,Ki.y,Ri.z,0,-Ri.x,Ci.z,0,-Ci.x,Ki.z,0,-Ki.x,-Ri.y,Ri.x,0,-Ci.y,Ci.x,0,-Ki.y,Ki.x,0];return!kl(t,vr,yr,xr,ga)||(t=[1,0,0,0,1,0,0,0,1],!kl(t,vr,yr,xr,ga))?!1:(_a.crossVectors(Ri,Ci),t=[_a.x,_a.y,_a.z],kl(t,vr,yr,xr,ga))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Gn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Gn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(_i[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),_i[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),_i[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),_i[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),_i[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),_i[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),_i[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),_i[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(_i),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},_i=[new j,new j,new j,new j,new j,new j,new j,new j],Gn=new j,ma=new Di,vr=new j,yr=new j,xr=new j,Ri=new j,Ci=new j,Ki=new j,es=new j,ga=new j,_a=new j,Qi=new j;function kl(i,e,t,n,s){for(let o=0,c=i.length-3;o<=c;o+=3){Qi.fromArray(i,o);let u=s.x*Math.abs(Qi.x)+s.y*Math.abs(Qi.y)+s.z*Math.abs(Qi.z),f=e.dot(Qi),d=t.dot(Qi),m=n.dot(Qi);if(Math.max(-Math.max(f,d,m),Math.min(f,d,m))>u)return!1}return!0}var Xt=new j,va=new et,L0=0,si=class extends Vn{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:L0++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=qu,this.updateRanges=[],this.gpuType=Xn,this.version=0,this._normalizationScale=e!==void 0?Pc(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,o=this.itemSize;s<o;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)va.fromBufferAttribute(this,t),va.applyMatrix3(e),this.setXY(t,va.x,va.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyMatrix3(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyMatrix4(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.applyNormalMatrix(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)Xt.fromBufferAttribute(this,t),Xt.transformDirection(e),this.setXYZ(t,Xt.x,Xt.y,Xt.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,o){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s),o=this._normalize(o)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=o,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):Ku(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):Qu(e,this.array)}};var ps=class extends si{constructor(e,t,n){super(new Uint16Array(e),t,n)}};var ms=class extends si{constructor(e,t,n){super(new Uint32Array(e),t,n)}};var kt=class extends si{constructor(e,t,n){super(new Float32Array(e),t,n)}},F0=new Di,ts=new j,zl=new j,nr=class{constructor(e=new j,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t!==void 0?n.copy(t):F0.setFromPoints(e).getCenter(n);let s=0;for(let o=0,c=e.length;o<c;o++)s=Math.max(s,n.distanceToSquared(e[o]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;ts.subVectors(e,this.center);let t=ts.lengthSq();if(t>this.radius*this.radius){let n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(ts,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(zl.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(ts.copy(e.center).add(zl)),this.expandByPoint(ts.copy(e.center).sub(zl))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},N0=0,Fn=new Lt,Gl=new ln,Sr=new j,An=new Di,ns=new Di,rn=new j,yn=class i extends Vn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:N0++}),this.uuid=Wr(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(a0(e)?ms:ps)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let o=new at().getNormalMatrix(e);n.applyNormalMatrix(o),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Fn.makeRotationFromQuaternion(e),this.applyMatrix4(Fn),this}rotateX(e){return Fn.makeRotationX(e),this.applyMatrix4(Fn),this}rotateY(e){return Fn.makeRotationY(e),this.applyMatrix4(Fn),this}rotateZ(e){return Fn.makeRotationZ(e),this.applyMatrix4(Fn),this}translate(e,t,n){return Fn.makeTranslation(e,t,n),this.applyMatrix4(Fn),this}scale(e,t,n){return Fn.makeScale(e,t,n),this.applyMatrix4(Fn),this}lookAt(e){return Gl.lookAt(e),Gl.updateMatrix(),this.applyMatrix4(Gl.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Sr).negate(),this.translate(Sr.x,Sr.y,Sr.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let n=[];for(let s=0,o=e.length;s<o;s++){let c=e[s];n.push(c.x,c.y,c.z||0)}this.setAttribute("position",new kt(n,3))}else{let n=Math.min(e.length,t.count);for(let s=0;s<n;s++){let o=e[s];t.setXYZ(s,o.x,o.y,o.z||0)}e.length>t.count&&Qe("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Di);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){tt("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new j(-1/0,-1/0,-1/0),new j(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){let o=t[n];An.setFromBufferAttribute(o),this.morphTargetsRelative?(rn.addVectors(this.boundingBox.min,An.min),this.boundingBox.expandByPoint(rn),rn.addVectors(this.boundingBox.max,An.max),this.boundingBox.expandByPoint(rn)):(this.boundingBox.expandByPoint(An.min),this.boundingBox.expandByPoint(An.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&tt('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new nr);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){tt("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new j,1/0);return}if(e){let n=this.boundingSphere.center;if(An.setFromBufferAttribute(e),t)for(let o=0,c=t.length;o<c;o++){let u=t[o];ns.setFromBufferAttribute(u),this.morphTargetsRelative?(rn.addVectors(An.min,ns.min),An.expandByPoint(rn),rn.addVectors(An.max,ns.max),An.expandByPoint(rn)):(An.expandByPoint(ns.min),An.expandByPoint(ns.max))}An.getCenter(n);let s=0;for(let o=0,c=e.count;o<c;o++)rn.fromBufferAttribute(e,o),s=Math.max(s,n.distanceToSquared(rn));if(t)for(let o=0,c=t.length;o<c;o++){let u=t[o],f=this.morphTargetsRelative;for(let d=0,m=u.count;d<m;d++)rn.fromBufferAttribute(u,d),f&&(Sr.fromBufferAttribute(e,d),rn.add(Sr)),s=Math.max(s,n.distanceToSquared(rn))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&tt('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){tt("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=t.position,s=t.normal,o=t.uv,c=this.getAttribute("tangent");(c===void 0||c.count!==n.count)&&(c=new si(new Float32Array(4*n.count),4),this.setAttribute("tangent",c));let u=[],f=[],d=new Uint8Array(n.count);for(let q=0;q<n.count;q++)u[q]=new j,f[q]=new j;let m=new j,y=new j,g=new j,S=new et,E=new et,C=new et,x=new j,v=new j;function P(q,k,Y){d[q]=d[k]=d[Y]=1,m.fromBufferAttribute(n,q),y.fromBufferAttribute(n,k),g.fromBufferAttribute(n,Y),S.fromBufferAttribute(o,q),E.fromBufferAttribute(o,k),C.fromBufferAttribute(o,Y),y.sub(m),g.sub(m),E.sub(S),C.sub(S);let J=1/(E.x*C.y-C.x*E.y);isFinite(J)&&(x.copy(y).multiplyScalar(C.y).addScaledVector(g,-E.y).multiplyScalar(J),v.copy(g).multiplyScalar(E.x).addScaledVector(y,-C.x).multiplyScalar(J),u[q].add(x),u[k].add(x),u[Y].add(x),f[q].add(v),f[k].add(v),f[Y].add(v))}let O=this.groups;O.length===0&&(O=[{start:0,count:e.count}]);for(let q=0,k=O.length;q<k;++q){let Y=O[q],J=Y.start,ee=Y.count;for(let z=J,ie=J+ee;z<ie;z+=3)P(e.getX(z+0),e.getX(z+1),e.getX(z+2))}let I=new j,U=new j,N=new j,b=new j;function D(q){N.fromBufferAttribute(s,q),b.copy(N);let k=u[q];I.copy(k),I.sub(N.multiplyScalar(N.dot(k))).normalize(),U.crossVectors(b,k);let J=U.dot(f[q])<0?-1:1;c.setXYZW(q,I.x,I.y,I.z,J)}for(let q=0,k=n.count;q<k;++q)d[q]&&D(q);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==t.count)n=new si(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let g=0,S=n.count;g<S;g++)n.setXYZ(g,0,0,0);let s=new j,o=new j,c=new j,u=new j,f=new j,d=new j,m=new j,y=new j;if(e)for(let g=0,S=e.count;g<S;g+=3){let E=e.getX(g+0),C=e.getX(g+1),x=e.getX(g+2);s.fromBufferAttribute(t,E),o.fromBufferAttribute(t,C),c.fromBufferAttribute(t,x),m.subVectors(c,o),y.subVectors(s,o),m.cross(y),u.fromBufferAttribute(n,E),f.fromBufferAttribute(n,C),d.fromBufferAttribute(n,x),u.add(m),f.add(m),d.add(m),n.setXYZ(E,u.x,u.y,u.z),n.setXYZ(C,f.x,f.y,f.z),n.setXYZ(x,d.x,d.y,d.z)}else for(let g=0,S=t.count;g<S;g+=3)s.fromBufferAttribute(t,g+0),o.fromBufferAttribute(t,g+1),c.fromBufferAttribute(t,g+2),m.subVectors(c,o),y.subVectors(s,o),m.cross(y),n.setXYZ(g+0,m.x,m.y,m.z),n.setXYZ(g+1,m.x,m.y,m.z),n.setXYZ(g+2,m.x,m.y,m.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)rn.fromBufferAttribute(e,t),rn.normalize(),e.setXYZ(t,rn.x,rn.y,rn.z)}toNonIndexed(){function e(u,f){let d=u.array,m=u.itemSize,y=u.normalized,g=new d.constructor(f.length*m),S=0,E=0;for(let C=0,x=f.length;C<x;C++){u.isInterleavedBufferAttribute?S=f[C]*u.data.stride+u.offset:S=f[C]*m;for(let v=0;v<m;v++)g[E++]=d[S++]}return new si(g,m,y)}if(this.index===null)return Qe("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new i,n=this.index.array,s=this.attributes;for(let u in s){let f=s[u],d=e(f,n);t.setAttribute(u,d)}let o=this.morphAttributes;for(let u in o){let f=[],d=o[u];for(let m=0,y=d.length;m<y;m++){let g=d[m],S=e(g,n);f.push(S)}t.morphAttributes[u]=f}t.morphTargetsRelative=this.morphTargetsRelative;let c=this.groups;for(let u=0,f=c.length;u<f;u++){let d=c[u];t.addGroup(d.start,d.count,d.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let f=this.parameters;for(let d in f)f[d]!==void 0&&(e[d]=f[d]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let f in n){let d=n[f];e.data.attributes[f]=d.toJSON(e.data)}let s={},o=!1;for(let f in this.morphAttributes){let d=this.morphAttributes[f],m=[];for(let y=0,g=d.length;y<g;y++){let S=d[y];m.push(S.toJSON(e.data))}m.length>0&&(s[f]=m,o=!0)}o&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let c=this.groups;c.length>0&&(e.data.groups=JSON.parse(JSON.stringify(c)));let u=this.boundingSphere;return u!==null&&(e.data.boundingSphere=u.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let s=e.attributes;for(let d in s){let m=s[d];this.setAttribute(d,m.clone(t))}let o=e.morphAttributes;for(let d in o){let m=[],y=o[d];for(let g=0,S=y.length;g<S;g++)m.push(y[g].clone(t));this.morphAttributes[d]=m}this.morphTargetsRelative=e.morphTargetsRelative;let c=e.groups;for(let d=0,m=c.length;d<m;d++){let y=c[d];this.addGroup(y.start,y.count,y.materialIndex)}let u=e.boundingBox;u!==null&&(this.boundingBox=u.clone());let f=e.boundingSphere;return f!==null&&(this.boundingSphere=f.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var Vl=new j,U0=new j,O0=new at,gn=class{constructor(e=new j(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let s=Vl.subVectors(n,t).cross(U0.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let s=e.delta(Vl),o=this.normal.dot(s);if(o===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let c=-(e.start.dot(this.normal)+this.constant)/o;return n===!0&&(c<0||c>1)?null:t.copy(e.start).addScaledVector(s,c)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||O0.getNormalMatrix(e),s=this.coplanarPoint(Vl).applyMatrix4(e),o=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(o),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},B0=0,ai=class extends Vn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:B0++}),this.uuid=Wr(),this.name="",this.type="Material",this.blending=Gr,this.side=Gi,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=sc,this.blendDst=ac,this.blendEquation=rr,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new ct(0,0,0),this.blendAlpha=0,this.depthFunc=Tr,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=Gu,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Na,this.stencilZFail=Na,this.stencilZPass=Na,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){Qe(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Qe(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(o=>o.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(o){let c=[];for(let u in o){let f=o[u];delete f.metadata,c.push(f)}return c}if(t){let o=s(e.textures),c=s(e.images);o.length>0&&(n.textures=o),c.length>0&&(n.images=c)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new ct().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(n=>new gn().fromJSON(n))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let n=e.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new et().fromArray(n)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new et().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let s=t.length;n=new Array(s);for(let o=0;o!==s;++o)n[o]=t[o].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var vi=new j,Hl=new j,ya=new j,xa=new j,Li=class{constructor(e=new j,t=new j(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,vi)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=vi.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(vi.copy(this.origin).addScaledVector(this.direction,t),vi.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){Hl.copy(e).add(t).multiplyScalar(.5),ya.copy(t).sub(e).normalize(),xa.copy(this.origin).sub(Hl);let o=e.distanceTo(t)*.5,c=-this.direction.dot(ya),u=xa.dot(this.direction),f=-xa.dot(ya),d=xa.lengthSq(),m=Math.abs(1-c*c),y,g,S,E;if(m>0)if(y=c*f-u,g=c*u-f,E=o*m,y>=0)if(g>=-E)if(g<=E){let C=1/m;y*=C,g*=C,S=y*(y+c*g+2*u)+g*(c*y+g+2*f)+d}else g=o,y=Math.max(0,-(c*g+u)),S=-y*y+g*(g+2*f)+d;else g=-o,y=Math.max(0,-(c*g+u)),S=-y*y+g*(g+2*f)+d;else g<=-E?(y=Math.max(0,-(-c*o+u)),g=y>0?-o:Math.min(Math.max(-o,-f),o),S=-y*y+g*(g+2*f)+d):g<=E?(y=0,g=Math.min(Math.max(-o,-f),o),S=g*(g+2*f)+d):(y=Math.max(0,-(c*o+u)),g=y>0?o:Math.min(Math.max(-o,-f),o),S=-y*y+g*(g+2*f)+d);else g=c>0?-o:o,y=Math.max(0,-(c*g+u)),S=-y*y+g*(g+2*f)+d;return n&&n.copy(this.origin).addScaledVector(this.direction,y),s&&s.copy(Hl).addScaledVector(ya,g),S}intersectSphere(e,t){if(e.radius<0)return null;vi.subVectors(e.center,this.origin);let n=vi.dot(this.direction),s=vi.dot(vi)-n*n,o=e.radius*e.radius;if(s>o)return null;let c=Math.sqrt(o-s),u=n-c,f=n+c;return f<0?null:u<0?this.at(f,t):this.at(u,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,o,c,u,f,d=1/this.direction.x,m=1/this.direction.y,y=1/this.direction.z,g=this.origin;return d>=0?(n=(e.min.x-g.x)*d,s=(e.max.x-g.x)*d):(n=(e.max.x-g.x)*d,s=(e.min.x-g.x)*d),m>=0?(o=(e.min.y-g.y)*m,c=(e.max.y-g.y)*m):(o=(e.max.y-g.y)*m,c=(e.min.y-g.y)*m),n>c||o>s||((o>n||isNaN(n))&&(n=o),(c<s||isNaN(s))&&(s=c),y>=0?(u=(e.min.z-g.z)*y,f=(e.max.z-g.z)*y):(u=(e.max.z-g.z)*y,f=(e.min.z-g.z)*y),n>f||u>s)||((u>n||n!==n)&&(n=u),(f<s||s!==s)&&(s=f),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,vi)!==null}intersectTriangle(e,t,n,s,o){let c=this.origin,u=this.direction,f=u.x,d=u.y,m=u.z,y=e.x-c.x,g=e.y-c.y,S=e.z-c.z,E=t.x-c.x,C=t.y-c.y,x=t.z-c.z,v=n.x-c.x,P=n.y-c.y,O=n.z-c.z,I=Math.abs(f),U=Math.abs(d),N=Math.abs(m),b,D,q,k,Y,J,ee,z,ie,G,ne,Se;if(I>=U&&I>=N?(q=f,J=y,ie=E,Se=v,f>=0?(b=d,D=m,k=g,Y=S,ee=C,z=x,G=P,ne=O):(b=m,D=d,k=S,Y=g,ee=x,z=C,G=O,ne=P)):U>=N?(q=d,J=g,ie=C,Se=P,d>=0?(b=m,D=f,k=S,Y=y,ee=x,z=E,G=O,ne=v):(b=f,D=m,k=y,Y=S,ee=E,z=x,G=v,ne=O)):(q=m,J=S,ie=x,Se=O,m>=0?(b=f,D=d,k=y,Y=g,ee=E,z=C,G=v,ne=P):(b=d,D=f,k=g,Y=y,ee=C,z=E,G=P,ne=v)),q===0)return null;let re=b/q,H=D/q,me=1/q,We=k-re*J,nt=Y-H*J,ue=ee-re*ie,Fe=z-H*ie,Pe=G-re*Se,Ye=ne-H*Se,Ue=Pe*Fe-Ye*ue,rt=We*Ye-nt*Pe,Gt=ue*nt-Fe*We;if(s){if(Ue<0||rt<0||Gt<0)return null}else if((Ue<0||rt<0||Gt<0)&&(Ue>0||rt>0||Gt>0))return null;let Ke=Ue+rt+Gt;if(Ke===0)return null;let bt=me*(Ue*J+rt*ie+Gt*Se);return(Ke>0?bt<0:bt>0)?null:this.at(bt/Ke,o)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Fr=class extends ai{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new ct(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Si,this.combine=oc,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},eu=new Lt,er=new Li,Sa=new nr,tu=new j,Ma=new j,ba=new j,Ea=new j,Wl=new j,wa=new j,nu=new j,Ta=new j,Mn=class extends ln{constructor(e=new yn,t=new Fr){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let o=0,c=s.length;o<c;o++){let u=s[o].name||String(o);this.morphTargetInfluences.push(0),this.morphTargetDictionary[u]=o}}}}getVertexPosition(e,t){let n=this.geometry,s=n.attributes.position,o=n.morphAttributes.position,c=n.morphTargetsRelative;t.fromBufferAttribute(s,e);let u=this.morphTargetInfluences;if(o&&u){wa.set(0,0,0);for(let f=0,d=o.length;f<d;f++){let m=u[f],y=o[f];m!==0&&(Wl.fromBufferAttribute(y,e),c?wa.addScaledVector(Wl,m):wa.addScaledVector(Wl.sub(t),m))}t.add(wa)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.material,o=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Sa.copy(n.boundingSphere),Sa.applyMatrix4(o),er.copy(e.ray).recast(e.near),!(Sa.containsPoint(er.origin)===!1&&(er.intersectSphere(Sa,tu)===null||er.origin.distanceToSquared(tu)>(e.far-e.near)**2))&&(eu.copy(o).invert(),er.copy(e.ray).applyMatrix4(eu),!(n.boundingBox!==null&&er.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(e,t,er)))}_computeIntersections(e,t,n){let s,o=this.geometry,c=this.material,u=o.index,f=o.attributes.position,d=o.attributes.uv,m=o.attributes.uv1,y=o.attributes.normal,g=o.groups,S=o.drawRange;if(u!==null)if(Array.isArray(c))for(let E=0,C=g.length;E<C;E++){let x=g[E],v=c[x.materialIndex],P=Math.max(x.start,S.start),O=Math.min(u.count,Math.min(x.start+x.count,S.start+S.count));for(let I=P,U=O;I<U;I+=3){let N=u.getX(I),b=u.getX(I+1),D=u.getX(I+2);s=Aa(this,v,e,n,d,m,y,N,b,D),s&&(s.faceIndex=Math.floor(I/3),s.face.materialIndex=x.materialIndex,t.push(s))}}else{let E=Math.max(0,S.start),C=Math.min(u.count,S.start+S.count);for(let x=E,v=C;x<v;x+=3){let P=u.getX(x),O=u.getX(x+1),I=u.getX(x+2);s=Aa(this,c,e,n,d,m,y,P,O,I),s&&(s.faceIndex=Math.floor(x/3),t.push(s))}}else if(f!==void 0)if(Array.isArray(c))for(let E=0,C=g.length;E<C;E++){let x=g[E],v=c[x.materialIndex],P=Math.max(x.start,S.start),O=Math.min(f.count,Math.min(x.start+x.count,S.start+S.count));for(let I=P,U=O;I<U;I+=3){let N=I,b=I+1,D=I+2;s=Aa(this,v,e,n,d,m,y,N,b,D),s&&(s.faceIndex=Math.floor(I/3),s.face.materialIndex=x.materialIndex,t.push(s))}}else{let E=Math.max(0,S.start),C=Math.min(f.count,S.start+S.count);for(let x=E,v=C;x<v;x+=3){let P=x,O=x+1,I=x+2;s=Aa(this,c,e,n,d,m,y,P,O,I),s&&(s.faceIndex=Math.floor(x/3),t.push(s))}}}};function k0(i,e,t,n,s,o,c,u){let f;if(e.side===xn?f=n.intersectTriangle(c,o,s,!0,u):f=n.intersectTriangle(s,o,c,e.side===Gi,u),f===null)return null;Ta.copy(u),Ta.applyMatrix4(i.matrixWorld);let d=t.ray.origin.distanceTo(Ta);return d<t.near||d>t.far?null:{distance:d,point:Ta.clone(),object:i}}function Aa(i,e,t,n,s,o,c,u,f,d){i.getVertexPosition(u,Ma),i.getVertexPosition(f,ba),i.getVertexPosition(d,Ea);let m=k0(i,e,t,n,Ma,ba,Ea,nu);if(m){let y=new j;Ii.getBarycoord(nu,Ma,ba,Ea,y),s&&(m.uv=Ii.getInterpolatedAttribute(s,u,f,d,y,new et)),o&&(m.uv1=Ii.getInterpolatedAttribute(o,u,f,d,y,new et)),c&&(m.normal=Ii.getInterpolatedAttribute(c,u,f,d,y,new j),m.normal.dot(n.direction)>0&&m.normal.multiplyScalar(-1));let g={a:u,b:f,c:d,normal:new j,materialIndex:0};Ii.getNormal(Ma,ba,Ea,g.normal),m.face=g,m.barycoord=y}return m}var Nr=class extends Sn{constructor(e=null,t=1,n=1,s,o,c,u,f,d=sn,m=sn,y,g){super(null,c,u,f,d,m,s,o,y,g),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var tr=new nr,z0=new et(.5,.5),Ra=new j,Fi=class{constructor(e=new gn,t=new gn,n=new gn,s=new gn,o=new gn,c=new gn){this.planes=[e,t,n,s,o,c]}set(e,t,n,s,o,c){let u=this.planes;return u[0].copy(e),u[1].copy(t),u[2].copy(n),u[3].copy(s),u[4].copy(o),u[5].copy(c),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=Nn,n=!1){let s=this.planes,o=e.elements,c=o[0],u=o[1],f=o[2],d=o[3],m=o[4],y=o[5],g=o[6],S=o[7],E=o[8],C=o[9],x=o[10],v=o[11],P=o[12],O=o[13],I=o[14],U=o[15];if(s[0].setComponents(d-c,S-m,v-E,U-P).normalize(),s[1].setComponents(d+c,S+m,v+E,U+P).normalize(),s[2].setComponents(d+u,S+y,v+C,U+O).normalize(),s[3].setComponents(d-u,S-y,v-C,U-O).normalize(),n)s[4].setComponents(f,g,x,I).normalize(),s[5].setComponents(d-f,S-g,v-x,U-I).normalize();else if(s[4].setComponents(d-f,S-g,v-x,U-I).normalize(),t===Nn)s[5].setComponents(d+f,S+g,v+x,U+I).normalize();else if(t===Rr)s[5].setComponents(f,g,x,I).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),tr.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),tr.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(tr)}intersectsSprite(e){tr.center.set(0,0,0);let t=z0.distanceTo(e.center);return tr.radius=.7071067811865476+t,tr.applyMatrix4(e.matrixWorld),this.intersectsSphere(tr)}intersectsSphere(e){let t=this.planes,n=e.center,s=-e.radius;for(let o=0;o<6;o++)if(t[o].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let s=t[n];if(Ra.x=s.normal.x>0?e.max.x:e.min.x,Ra.y=s.normal.y>0?e.max.y:e.min.y,Ra.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Ra)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},iu=new Lt,Ya=class i{constructor(){this.coordinateSystem=Nn,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let s=0;s<t.length;s++){let o=t[s];iu.multiplyMatrices(o.projectionMatrix,o.matrixWorldInverse),n[s]===void 0&&(n[s]=new Fi),n[s].setFromProjectionMatrix(iu,o.coordinateSystem,o.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new Fi),t[s].copy(n[s]);return this._count=e._count,this}clone(){return new i().copy(this)}};var Ur=class extends ai{constructor(e){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new ct(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},ja=new j,Za=new j,ru=new Lt,is=new Li,Ca=new nr,Xl=new j,su=new j,gs=class extends ln{constructor(e=new yn,t=new Ur){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let s=1,o=t.count;s<o;s++)ja.fromBufferAttribute(t,s-1),Za.fromBufferAttribute(t,s),n[s]=n[s-1],n[s]+=ja.distanceTo(Za);e.setAttribute("lineDistance",new kt(n,1))}else Qe("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.matrixWorld,o=e.params.Line.threshold,c=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),Ca.copy(n.boundingSphere),Ca.applyMatrix4(s),Ca.radius+=o,e.ray.intersectsSphere(Ca)===!1)return;ru.copy(s).invert(),is.copy(e.ray).applyMatrix4(ru);let u=o/((this.scale.x+this.scale.y+this.scale.z)/3),f=u*u,d=this.isLineSegments?2:1,m=n.index,g=n.attributes.position;if(m!==null){let S=Math.max(0,c.start),E=Math.min(m.count,c.start+c.count);for(let C=S,x=E-1;C<x;C+=d){let v=m.getX(C),P=m.getX(C+1),O=Pa(this,e,is,f,v,P,C);O&&t.push(O)}if(this.isLineLoop){let C=m.getX(E-1),x=m.getX(S),v=Pa(this,e,is,f,C,x,E-1);v&&t.push(v)}}else{let S=Math.max(0,c.start),E=Math.min(g.count,c.start+c.count);for(let C=S,x=E-1;C<x;C+=d){let v=Pa(this,e,is,f,C,C+1,C);v&&t.push(v)}if(this.isLineLoop){let C=Pa(this,e,is,f,E-1,S,E-1);C&&t.push(C)}}}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let o=0,c=s.length;o<c;o++){let u=s[o].name||String(o);this.morphTargetInfluences.push(0),this.morphTargetDictionary[u]=o}}}}};function Pa(i,e,t,n,s,o,c){let u=i.geometry.attributes.position;if(ja.fromBufferAttribute(u,s),Za.fromBufferAttribute(u,o),t.distanceSqToSegment(ja,Za,Xl,su)>n)return;Xl.applyMatrix4(i.matrixWorld);let d=e.ray.origin.distanceTo(Xl);if(!(d<e.near||d>e.far))return{distance:d,point:su.clone().applyMatrix4(i.matrixWorld),index:c,face:null,faceIndex:null,barycoord:null,object:i}}var _s=class extends Sn{constructor(e=[],t=sr,n,s,o,c,u,f,d,m){super(e,t,n,s,o,c,u,f,d,m),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Mi=class extends Sn{constructor(e,t,n=Wn,s,o,c,u=sn,f=sn,d,m=xi,y=1){if(m!==xi&&m!==bi)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let g={width:e,height:t,depth:y};super(g,s,o,c,u,f,m,n,d),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Ir(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},vs=class extends Mi{constructor(e,t=Wn,n=sr,s,o,c=sn,u=sn,f,d=xi){let m={width:e,height:e,depth:1},y=[m,m,m,m,m,m];super(e,e,t,n,s,o,c,u,f,d),this.image=y,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},ys=class extends Sn{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},Ni=class i extends yn{constructor(e=1,t=1,n=1,s=1,o=1,c=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:o,depthSegments:c};let u=this;s=Math.floor(s),o=Math.floor(o),c=Math.floor(c);let f=[],d=[],m=[],y=[],g=0,S=0;E("z","y","x",-1,-1,n,t,e,c,o,0),E("z","y","x",1,-1,n,t,-e,c,o,1),E("x","z","y",1,1,e,n,t,s,c,2),E("x","z","y",1,-1,e,n,-t,s,c,3),E("x","y","z",1,-1,e,t,n,s,o,4),E("x","y","z",-1,-1,e,t,-n,s,o,5),this.setIndex(f),this.setAttribute("position",new kt(d,3)),this.setAttribute("normal",new kt(m,3)),this.setAttribute("uv",new kt(y,2));function E(C,x,v,P,O,I,U,N,b,D,q){let k=I/b,Y=U/D,J=I/2,ee=U/2,z=N/2,ie=b+1,G=D+1,ne=0,Se=0,re=new j;for(let H=0;H<G;H++){let me=H*Y-ee;for(let We=0;We<ie;We++){let nt=We*k-J;re[C]=nt*P,re[x]=me*O,re[v]=z,d.push(re.x,re.y,re.z),re[C]=0,re[x]=0,re[v]=N>0?1:-1,m.push(re.x,re.y,re.z),y.push(We/b),y.push(1-H/D),ne+=1}}for(let H=0;H<D;H++)for(let me=0;me<b;me++){let We=g+me+ie*H,nt=g+me+ie*(H+1),ue=g+(me+1)+ie*(H+1),Fe=g+(me+1)+ie*H;f.push(We,nt,Fe),f.push(nt,ue,Fe),Se+=6}u.addGroup(S,Se,q),S+=Se,g+=ne}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}},xs=class i extends yn{constructor(e=1,t=1,n=4,s=8,o=1){super(),this.type="CapsuleGeometry",this.parameters={radius:e,height:t,capSegments:n,radialSegments:s,heightSegments:o},t=Math.max(0,t),n=Math.max(1,Math.floor(n)),s=Math.max(3,Math.floor(s)),o=Math.max(1,Math.floor(o));let c=[],u=[],f=[],d=[],m=t/2,y=Math.PI/2*e,g=t,S=2*y+g,E=n*2+o,C=s+1,x=new j,v=new j;for(let P=0;P<=E;P++){let O=0,I=0,U=0,N=0;if(P<=n){let q=P/n,k=q*Math.PI/2;I=-m-e*Math.cos(k),U=e*Math.sin(k),N=-e*Math.cos(k),O=q*y}else if(P<=n+o){let q=(P-n)/o;I=-m+q*t,U=e,N=0,O=y+q*g}else{let q=(P-n-o)/n,k=q*Math.PI/2;I=m+e*Math.sin(k),U=e*Math.cos(k),N=e*Math.sin(k),O=y+g+q*y}let b=Math.max(0,Math.min(1,O/S)),D=0;P===0?D=.5/s:P===E&&(D=-.5/s);for(let q=0;q<=s;q++){let k=q/s,Y=k*Math.PI*2,J=Math.sin(Y),ee=Math.cos(Y);v.x=-U*ee,v.y=I,v.z=U*J,u.push(v.x,v.y,v.z),x.set(-U*ee,N,U*J),x.normalize(),f.push(x.x,x.y,x.z),d.push(k+D,b)}if(P>0){let q=(P-1)*C;for(let k=0;k<s;k++){let Y=q+k,J=q+k+1,ee=P*C+k,z=P*C+k+1;c.push(Y,J,ee),c.push(J,z,ee)}}}this.setIndex(c),this.setAttribute("position",new kt(u,3)),this.setAttribute("normal",new kt(f,3)),this.setAttribute("uv",new kt(d,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.height,e.capSegments,e.radialSegments,e.heightSegments)}},Ss=class i extends yn{constructor(e=1,t=32,n=0,s=Math.PI*2){super(),this.type="CircleGeometry",this.parameters={radius:e,segments:t,thetaStart:n,thetaLength:s},t=Math.max(3,t);let o=[],c=[],u=[],f=[],d=new j,m=new et;c.push(0,0,0),u.push(0,0,1),f.push(.5,.5);for(let y=0,g=3;y<=t;y++,g+=3){let S=n+y/t*s;d.x=e*Math.cos(S),d.y=e*Math.sin(S),c.push(d.x,d.y,d.z),u.push(0,0,1),m.x=(c[g]/e+1)/2,m.y=(c[g+1]/e+1)/2,f.push(m.x,m.y)}for(let y=1;y<=t;y++)o.push(y,y+1,0);this.setIndex(o),this.setAttribute("position",new kt(c,3)),this.setAttribute("normal",new kt(u,3)),this.setAttribute("uv",new kt(f,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.segments,e.thetaStart,e.thetaLength)}},Ms=class i extends yn{constructor(e=1,t=1,n=1,s=32,o=1,c=!1,u=0,f=Math.PI*2){super(),this.type="CylinderGeometry",this.parameters={radiusTop:e,radiusBottom:t,height:n,radialSegments:s,heightSegments:o,openEnded:c,thetaStart:u,thetaLength:f};let d=this;s=Math.floor(s),o=Math.floor(o);let m=[],y=[],g=[],S=[],E=0,C=[],x=n/2,v=0;P(),c===!1&&(e>0&&O(!0),t>0&&O(!1)),this.setIndex(m),this.setAttribute("position",new kt(y,3)),this.setAttribute("normal",new kt(g,3)),this.setAttribute("uv",new kt(S,2));function P(){let I=new j,U=new j,N=0,b=(t-e)/n;for(let D=0;D<=o;D++){let q=[],k=D/o,Y=k*(t-e)+e;for(let J=0;J<=s;J++){let ee=J/s,z=ee*f+u,ie=Math.sin(z),G=Math.cos(z);U.x=Y*ie,U.y=-k*n+x,U.z=Y*G,y.push(U.x,U.y,U.z),I.set(ie,b,G).normalize(),g.push(I.x,I.y,I.z),S.push(ee,1-k),q.push(E++)}C.push(q)}for(let D=0;D<s;D++)for(let q=0;q<o;q++){let k=C[q][D],Y=C[q+1][D],J=C[q+1][D+1],ee=C[q][D+1];(e>0||q!==0)&&(m.push(k,Y,ee),N+=3),(t>0||q!==o-1)&&(m.push(Y,J,ee),N+=3)}d.addGroup(v,N,0),v+=N}function O(I){let U=E,N=new et,b=new j,D=0,q=I===!0?e:t,k=I===!0?1:-1;for(let J=1;J<=s;J++)y.push(0,x*k,0),g.push(0,k,0),S.push(.5,.5),E++;let Y=E;for(let J=0;J<=s;J++){let z=J/s*f+u,ie=Math.cos(z),G=Math.sin(z);b.x=q*G,b.y=x*k,b.z=q*ie,y.push(b.x,b.y,b.z),g.push(0,k,0),N.x=ie*.5+.5,N.y=G*.5*k+.5,S.push(N.x,N.y),E++}for(let J=0;J<s;J++){let ee=U+J,z=Y+J;I===!0?m.push(z,z+1,ee):m.push(z+1,z,ee),D+=3}d.addGroup(v,D,I===!0?1:2),v+=D}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radiusTop,e.radiusBottom,e.height,e.radialSegments,e.heightSegments,e.openEnded,e.thetaStart,e.thetaLength)}};var bs=class i extends yn{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};let o=e/2,c=t/2,u=Math.floor(n),f=Math.floor(s),d=u+1,m=f+1,y=e/u,g=t/f,S=[],E=[],C=[],x=[];for(let v=0;v<m;v++){let P=v*g-c;for(let O=0;O<d;O++){let I=O*y-o;E.push(I,-P,0),C.push(0,0,1),x.push(O/u),x.push(1-v/f)}}for(let v=0;v<f;v++)for(let P=0;P<u;P++){let O=P+d*v,I=P+d*(v+1),U=P+1+d*(v+1),N=P+1+d*v;S.push(O,I,N),S.push(I,U,N)}this.setIndex(S),this.setAttribute("position",new kt(E,3)),this.setAttribute("normal",new kt(C,3)),this.setAttribute("uv",new kt(x,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.widthSegments,e.heightSegments)}};var Or=class i extends yn{constructor(e=1,t=32,n=16,s=0,o=Math.PI*2,c=0,u=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:e,widthSegments:t,heightSegments:n,phiStart:s,phiLength:o,thetaStart:c,thetaLength:u},t=Math.max(3,Math.floor(t)),n=Math.max(2,Math.floor(n));let f=Math.min(c+u,Math.PI),d=0,m=[],y=new j,g=new j,S=[],E=[],C=[],x=[];for(let v=0;v<=n;v++){let P=[],O=v/n,I=c+O*u,U=e*Math.cos(I),N=Math.sqrt(e*e-U*U),b=0;v===0&&c===0?b=.5/t:v===n&&f===Math.PI&&(b=-.5/t);for(let D=0;D<=t;D++){let q=D/t,k=s+q*o;y.x=-N*Math.cos(k),y.y=U,y.z=N*Math.sin(k),E.push(y.x,y.y,y.z),g.copy(y).normalize(),C.push(g.x,g.y,g.z),x.push(q+b,1-O),P.push(d++)}m.push(P)}for(let v=0;v<n;v++)for(let P=0;P<t;P++){let O=m[v][P+1],I=m[v][P],U=m[v+1][P],N=m[v+1][P+1];(v!==0||c>0)&&S.push(O,I,N),(v!==n-1||f<Math.PI)&&S.push(I,U,N)}this.setIndex(S),this.setAttribute("position",new kt(E,3)),this.setAttribute("normal",new kt(C,3)),this.setAttribute("uv",new kt(x,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.radius,e.widthSegments,e.heightSegments,e.phiStart,e.phiLength,e.thetaStart,e.thetaLength)}};var Es=class extends ai{constructor(e){super(),this.isShadowMaterial=!0,this.type="ShadowMaterial",this.color=new ct(0),this.transparent=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.fog=e.fog,this}};function or(i){let e={};for(let t in i){e[t]={};for(let n in i[t]){let s=i[t][n];if(au(s))s.isRenderTargetTexture?(Qe("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone();else if(Array.isArray(s))if(au(s[0])){let o=[];for(let c=0,u=s.length;c<u;c++)o[c]=s[c].clone();e[t][n]=o}else e[t][n]=s.slice();else e[t][n]=s}}return e}function fn(i){let e={};for(let t=0;t<i.length;t++){let n=or(i[t]);for(let s in n)e[s]=n[s]}return e}function au(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function G0(i){let e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function Dc(i){let e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:yt.workingColorSpace}var td={clone:or,merge:fn},V0=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,H0=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,oi=class extends ai{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=V0,this.fragmentShader=H0,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=or(e.uniforms),this.uniformsGroups=G0(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let c=this.uniforms[s].value;c&&c.isTexture?t.uniforms[s]={type:"t",value:c.toJSON(e).uuid}:c&&c.isColor?t.uniforms[s]={type:"c",value:c.getHex()}:c&&c.isVector2?t.uniforms[s]={type:"v2",value:c.toArray()}:c&&c.isVector3?t.uniforms[s]={type:"v3",value:c.toArray()}:c&&c.isVector4?t.uniforms[s]={type:"v4",value:c.toArray()}:c&&c.isMatrix3?t.uniforms[s]={type:"m3",value:c.toArray()}:c&&c.isMatrix4?t.uniforms[s]={type:"m4",value:c.toArray()}:t.uniforms[s]={value:c}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let s=e.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=t[s.value]||null;break;case"c":this.uniforms[n].value=new ct().setHex(s.value);break;case"v2":this.uniforms[n].value=new et().fromArray(s.value);break;case"v3":this.uniforms[n].value=new j().fromArray(s.value);break;case"v4":this.uniforms[n].value=new zt().fromArray(s.value);break;case"m3":this.uniforms[n].value=new at().fromArray(s.value);break;case"m4":this.uniforms[n].value=new Lt().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let n in e.extensions)this.extensions[n]=e.extensions[n];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Ja=class extends oi{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}},ws=class extends ai{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type="MeshStandardMaterial",this.defines={STANDARD:""},this.color=new ct(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new ct(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Ko,this.normalScale=new et(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Si,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:""},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}};var Ka=class extends ai{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=ku,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Qa=class extends ai{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function Mr(i,e){return!i||i.constructor===e?i:typeof e.BYTES_PER_ELEMENT=="number"?new e(i):Array.prototype.slice.call(i)}function Ia(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var Ui=class{constructor(e,t,n,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(n),this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,s=t[n],o=t[n-1];e:{t:{let c;n:{i:if(!(e<s)){for(let u=n+2;;){if(s===void 0){if(e<o)break i;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===u)break;if(o=s,s=t[++n],e<s)break t}c=t.length;break n}if(!(e>=o)){let u=t[1];e<u&&(n=2,o=u);for(let f=n-2;;){if(o===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===f)break;if(s=o,o=t[--n-1],e>=o)break t}c=n,n=0;break n}break e}for(;n<c;){let u=n+c>>>1;e<t[u]?c=u:n=u+1}if(s=t[n],o=t[n-1],o===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,o,s)}return this.interpolate_(n,o,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,s=this.valueSize,o=e*s;for(let c=0;c!==s;++c)t[c]=n[o+c];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},eo=class extends Ui{constructor(e,t,n,s){super(e,t,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Yl,endingEnd:Yl}}intervalChanged_(e,t,n){let s=this.parameterPositions,o=e-2,c=e+1,u=s[o],f=s[c];if(u===void 0)switch(this.getSettings_().endingStart){case jl:o=e,u=2*t-n;break;case Zl:o=s.length-2,u=t+s[o]-s[o+1];break;default:o=e,u=n}if(f===void 0)switch(this.getSettings_().endingEnd){case jl:c=e,f=2*n-t;break;case Zl:c=1,f=n+s[1]-s[0];break;default:c=e-1,f=t}let d=(n-t)*.5,m=this.valueSize;this._weightPrev=d/(t-u),this._weightNext=d/(f-n),this._offsetPrev=o*m,this._offsetNext=c*m}interpolate_(e,t,n,s){let o=this.resultBuffer,c=this.sampleValues,u=this.valueSize,f=e*u,d=f-u,m=this._offsetPrev,y=this._offsetNext,g=this._weightPrev,S=this._weightNext,E=(n-t)/(s-t),C=E*E,x=C*E,v=-g*x+2*g*C-g*E,P=(1+g)*x+(-1.5-2*g)*C+(-.5+g)*E+1,O=(-1-S)*x+(1.5+S)*C+.5*E,I=S*x-S*C;for(let U=0;U!==u;++U)o[U]=v*c[m+U]+P*c[d+U]+O*c[f+U]+I*c[y+U];return o}},to=class extends Ui{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let o=this.resultBuffer,c=this.sampleValues,u=this.valueSize,f=e*u,d=f-u,m=(n-t)/(s-t),y=1-m;for(let g=0;g!==u;++g)o[g]=c[d+g]*y+c[f+g]*m;return o}},no=class extends Ui{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e){return this.copySampleValue_(e-1)}},io=class extends Ui{interpolate_(e,t,n,s){let o=this.resultBuffer,c=this.sampleValues,u=this.valueSize,f=e*u,d=f-u,m=this.inTangents,y=this.outTangents;if(!m||!y){let E=(n-t)/(s-t),C=1-E;for(let x=0;x!==u;++x)o[x]=c[d+x]*C+c[f+x]*E;return o}let g=u*2,S=e-1;for(let E=0;E!==u;++E){let C=c[d+E],x=c[f+E],v=S*g+E*2,P=y[v],O=y[v+1],I=e*g+E*2,U=m[I],N=m[I+1],b=X0(n,t,P,U,s);o[E]=nd(b,C,O,N,x)}return o}};function nd(i,e,t,n,s){let o=1-i;return o*o*o*e+3*o*o*i*t+3*o*i*i*n+i*i*i*s}function W0(i,e,t,n,s){let o=1-i;return 3*o*o*(t-e)+6*o*i*(n-t)+3*i*i*(s-n)}function X0(i,e,t,n,s){let o=(i-e)/(s-e);for(let c=0;c<8;c++){let u=nd(o,e,t,n,s)-i;if(Math.abs(u)<1e-10)break;let f=W0(o,e,t,n,s);if(Math.abs(f)<1e-10)break;o=Math.max(0,Math.min(1,o-u/f))}return o}var Pn=class{constructor(e,t,n,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=Mr(t,this.TimeBufferType),this.values=Mr(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:Mr(e.times,Array),values:Mr(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(n.interpolation=s),Ia(e.settings)&&(n.settings={inTangents:Mr(e.settings.inTangents,Array),outTangents:Mr(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new no(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new to(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new eo(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new io(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case os:t=this.InterpolantFactoryMethodDiscrete;break;case Wa:t=this.InterpolantFactoryMethodLinear;break;case Fa:t=this.InterpolantFactoryMethodSmooth;break;case ql:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return Qe("KeyframeTrack:",n),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return os;case this.InterpolantFactoryMethodLinear:return Wa;case this.InterpolantFactoryMethodSmooth:return Fa;case this.InterpolantFactoryMethodBezier:return ql}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]+=e;Ia(this.settings)&&(ou(this.settings.inTangents,e),ou(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]*=e;Ia(this.settings)&&(lu(this.settings.inTangents,e),lu(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,s=n.length,o=0,c=s-1;for(;o!==s&&n[o]<e;)++o;for(;c!==-1&&n[c]>t;)--c;if(++c,o!==0||c!==s){o>=c&&(c=Math.max(c,1),o=c-1);let u=this.getValueSize();this.times=n.slice(o,c),this.values=this.values.slice(o*u,c*u)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(tt("KeyframeTrack: Invalid value size in track.",this),e=!1);let n=this.times,s=this.values,o=n.length;o===0&&(tt("KeyframeTrack: Track is empty.",this),e=!1);let c=null;for(let u=0;u!==o;u++){let f=n[u];if(typeof f=="number"&&isNaN(f)){tt("KeyframeTrack: Time is not a valid number.",this,u,f),e=!1;break}if(c!==null&&c>f){tt("KeyframeTrack: Out of order keys.",this,u,f,c),e=!1;break}c=f}if(s!==void 0&&o0(s))for(let u=0,f=s.length;u!==f;++u){let d=s[u];if(isNaN(d)){tt("KeyframeTrack: Value is not a valid number.",this,u,d),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===Fa,o=e.length-1,c=1;for(let u=1;u<o;++u){let f=!1,d=e[u],m=e[u+1];if(d!==m&&(u!==1||d!==e[0]))if(s)f=!0;else{let y=u*n,g=y-n,S=y+n;for(let E=0;E!==n;++E){let C=t[y+E];if(C!==t[g+E]||C!==t[S+E]){f=!0;break}}}if(f){if(u!==c){e[c]=e[u];let y=u*n,g=c*n;for(let S=0;S!==n;++S)t[g+S]=t[y+S]}++c}}if(o>0){e[c]=e[o];for(let u=o*n,f=c*n,d=0;d!==n;++d)t[f+d]=t[u+d];++c}return c!==e.length?(this.times=e.slice(0,c),this.values=t.slice(0,c*n)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,s=new n(this.name,e,t);return s.createInterpolant=this.createInterpolant,Ia(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function ou(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]+=e}function lu(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]*=e}Pn.prototype.ValueTypeName="";Pn.prototype.TimeBufferType=Float32Array;Pn.prototype.ValueBufferType=Float32Array;Pn.prototype.DefaultInterpolation=Wa;var Oi=class extends Pn{constructor(e,t,n){super(e,t,n)}};Oi.prototype.ValueTypeName="bool";Oi.prototype.ValueBufferType=Array;Oi.prototype.DefaultInterpolation=os;Oi.prototype.InterpolantFactoryMethodLinear=void 0;Oi.prototype.InterpolantFactoryMethodSmooth=void 0;var ro=class extends Pn{constructor(e,t,n,s){super(e,t,n,s)}};ro.prototype.ValueTypeName="color";var so=class extends Pn{constructor(e,t,n,s){super(e,t,n,s)}};so.prototype.ValueTypeName="number";var ao=class extends Ui{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let o=this.resultBuffer,c=this.sampleValues,u=this.valueSize,f=(n-t)/(s-t),d=e*u;for(let m=d+u;d!==m;d+=4)Rn.slerpFlat(o,0,c,d-u,c,d,f);return o}},Ts=class extends Pn{constructor(e,t,n,s){super(e,t,n,s)}InterpolantFactoryMethodLinear(e){return new ao(this.times,this.values,this.getValueSize(),e)}};Ts.prototype.ValueTypeName="quaternion";Ts.prototype.InterpolantFactoryMethodSmooth=void 0;var Bi=class extends Pn{constructor(e,t,n){super(e,t,n)}};Bi.prototype.ValueTypeName="string";Bi.prototype.ValueBufferType=Array;Bi.prototype.DefaultInterpolation=os;Bi.prototype.InterpolantFactoryMethodLinear=void 0;Bi.prototype.InterpolantFactoryMethodSmooth=void 0;var oo=class extends Pn{constructor(e,t,n,s){super(e,t,n,s)}};oo.prototype.ValueTypeName="vector";var lo=class{constructor(e,t,n){let s=this,o=!1,c=0,u=0,f,d=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this._abortController=null,this.itemStart=function(m){u++,o===!1&&s.onStart!==void 0&&s.onStart(m,c,u),o=!0},this.itemEnd=function(m){c++,s.onProgress!==void 0&&s.onProgress(m,c,u),c===u&&(o=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(m){s.onError!==void 0&&s.onError(m)},this.resolveURL=function(m){return m=m.normalize("NFC"),f?f(m):m},this.setURLModifier=function(m){return f=m,this},this.addHandler=function(m,y){return d.push(m,y),this},this.removeHandler=function(m){let y=d.indexOf(m);return y!==-1&&d.splice(y,2),this},this.getHandler=function(m){for(let y=0,g=d.length;y<g;y+=2){let S=d[y],E=d[y+1];if(S.global&&(S.lastIndex=0),S.test(m))return E}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},id=new lo,co=class{constructor(e){this.manager=e!==void 0?e:id,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let n=this;return new Promise(function(s,o){n.load(e,s,t,o)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};co.DEFAULT_MATERIAL_NAME="__DEFAULT";var As=class extends ln{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type="Light",this.color=new ct(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}},Rs=class extends As{constructor(e,t,n){super(e,n),this.isHemisphereLight=!0,this.type="HemisphereLight",this.position.copy(ln.DEFAULT_UP),this.updateMatrix(),this.groundColor=new ct(t)}copy(e,t){return super.copy(e,t),this.groundColor.copy(e.groundColor),this}toJSON(e){let t=super.toJSON(e);return t.object.groundColor=this.groundColor.getHex(),t}},$l=new Lt,cu=new j,hu=new j,ho=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new et(512,512),this.mapType=bn,this.map=null,this.mapPass=null,this.matrix=new Lt,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new Fi,this._frameExtents=new et(1,1),this._viewportCount=1,this._viewports=[new zt(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;cu.setFromMatrixPosition(e.matrixWorld),t.position.copy(cu),hu.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(hu),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,s){$l.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix($l,e.coordinateSystem,e.reversedDepth);let o=this._frameExtents,c=s?s.z/o.x:1,u=s?s.w/o.y:1,f=s?s.x/o.x:0,d=s?s.y/o.y:0;e.coordinateSystem===Rr||e.reversedDepth?t.set(.5*c,0,0,.5*c+f,0,.5*u,0,.5*u+d,0,0,1,0,0,0,0,1):t.set(.5*c,0,0,.5*c+f,0,.5*u,0,.5*u+d,0,0,.5,.5,0,0,0,1),t.multiply($l)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},Da=new j,La=new Rn,ni=new j,Cs=class extends ln{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Lt,this.projectionMatrix=new Lt,this.projectionMatrixInverse=new Lt,this.coordinateSystem=Nn,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Da,La,ni),ni.x===1&&ni.y===1&&ni.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Da,La,ni.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Da,La,ni),ni.x===1&&ni.y===1&&ni.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Da,La,ni.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},Pi=new j,uu=new et,du=new et,_n=class extends Cs{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=Pr*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(ss*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return Pr*2*Math.atan(Math.tan(ss*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){Pi.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(Pi.x,Pi.y).multiplyScalar(-e/Pi.z),Pi.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(Pi.x,Pi.y).multiplyScalar(-e/Pi.z)}getViewSize(e,t){return this.getViewBounds(e,uu,du),t.subVectors(du,uu)}setViewOffset(e,t,n,s,o,c){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=o,this.view.height=c,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(ss*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,o=-.5*s,c=this.view;if(this.view!==null&&this.view.enabled){let f=c.fullWidth,d=c.fullHeight;o+=c.offsetX*s/f,t-=c.offsetY*n/d,s*=c.width/f,n*=c.height/d}let u=this.filmOffset;u!==0&&(o+=e*u/this.getFilmWidth()),this.projectionMatrix.makePerspective(o,o+s,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var Ps=class extends Cs{constructor(e=-1,t=1,n=1,s=-1,o=.1,c=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=o,this.far=c,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,o,c){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=o,this.view.height=c,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,o=n-e,c=n+e,u=s+t,f=s-t;if(this.view!==null&&this.view.enabled){let d=(this.right-this.left)/this.view.fullWidth/this.zoom,m=(this.top-this.bottom)/this.view.fullHeight/this.zoom;o+=d*this.view.offsetX,c=o+d*this.view.width,u-=m*this.view.offsetY,f=u-m*this.view.height}this.projectionMatrix.makeOrthographic(o,c,u,f,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},Jl=class extends ho{constructor(){super(new Ps(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},Is=class extends As{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(ln.DEFAULT_UP),this.updateMatrix(),this.target=new ln,this.shadow=new Jl}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}};var br=-90,Er=1,Br=class extends ln{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new _n(br,Er,e,t);s.layers=this.layers,this.add(s);let o=new _n(br,Er,e,t);o.layers=this.layers,this.add(o);let c=new _n(br,Er,e,t);c.layers=this.layers,this.add(c);let u=new _n(br,Er,e,t);u.layers=this.layers,this.add(u);let f=new _n(br,Er,e,t);f.layers=this.layers,this.add(f);let d=new _n(br,Er,e,t);d.layers=this.layers,this.add(d)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,s,o,c,u,f]=t;for(let d of t)this.remove(d);if(e===Nn)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),o.up.set(0,0,-1),o.lookAt(0,1,0),c.up.set(0,0,1),c.lookAt(0,-1,0),u.up.set(0,1,0),u.lookAt(0,0,1),f.up.set(0,1,0),f.lookAt(0,0,-1);else if(e===Rr)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),o.up.set(0,0,1),o.lookAt(0,1,0),c.up.set(0,0,-1),c.lookAt(0,-1,0),u.up.set(0,-1,0),u.lookAt(0,0,1),f.up.set(0,-1,0),f.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let d of t)this.add(d),d.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[o,c,u,f,d,m]=this.children,y=e.getRenderTarget(),g=e.getActiveCubeFace(),S=e.getActiveMipmapLevel(),E=e.xr.enabled;e.xr.enabled=!1;let C=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let x=!1;e.isWebGLRenderer===!0?x=e.state.buffers.depth.getReversed():x=e.reversedDepthBuffer,e.setRenderTarget(n,0,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,1,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),e.setRenderTarget(n,2,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,u),e.setRenderTarget(n,3,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,f),e.setRenderTarget(n,4,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,d),n.texture.mipmapsAutoUpdate=C,e.setRenderTarget(n,5,s),x&&e.autoClear===!1&&e.clearDepth(),e.render(t,m),e.setRenderTarget(y,g,S),e.xr.enabled=E,n.texture.needsPMREMUpdate=!0}},uo=class extends _n{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var Lc="\\[\\]\\.:\\/",$0=new RegExp("["+Lc+"]","g"),Fc="[^"+Lc+"]",q0="[^"+Lc.replace("\\.","")+"]",Y0=/((?:WC+[\/:])*)/.source.replace("WC",Fc),j0=/(WCOD+)?/.source.replace("WCOD",q0),Z0=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Fc),J0=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Fc),K0=new RegExp("^"+Y0+j0+Z0+J0+"$"),Q0=["material","materials","bones","map"],Kl=class{constructor(e,t,n){let s=n||Bt.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,o=n.length;s!==o;++s)n[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},Bt=class i{constructor(e,t,n){this.path=t,this.parsedPath=n||i.parseTrackName(t),this.node=i.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,n){return e&&e.isAnimationObjectGroup?new i.Composite(e,t,n):new i(e,t,n)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace($0,"")}static parseTrackName(e){let t=K0.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let o=n.nodeName.substring(s+1);Q0.indexOf(o)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=o)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return n}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(o){for(let c=0;c<o.length;c++){let u=o[c];if(u.name===t||u.uuid===t)return u;let f=n(u.children);if(f)return f}return null},s=n(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let s=0,o=n.length;s!==o;++s)e[t++]=n[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let s=0,o=n.length;s!==o;++s)n[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,o=n.length;s!==o;++s)n[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,o=n.length;s!==o;++s)n[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,n=t.objectName,s=t.propertyName,o=t.propertyIndex;if(e||(e=i.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){Qe("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let d=t.objectIndex;switch(n){case"materials":if(!e.material){tt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){tt("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){tt("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let m=0;m<e.length;m++)if(e[m].name===d){d=m;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){tt("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){tt("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[n]===void 0){tt("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[n]}if(d!==void 0){if(e[d]===void 0){tt("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[d]}}let c=e[s];if(c===void 0){let d=t.nodeName;tt("PropertyBinding: Trying to update property for track: "+d+"."+s+" but it wasn't found.",e);return}let u=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?u=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(u=this.Versioning.MatrixWorldNeedsUpdate);let f=this.BindingType.Direct;if(o!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){tt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){tt("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[o]!==void 0&&(o=e.morphTargetDictionary[o])}f=this.BindingType.ArrayElement,this.resolvedProperty=c,this.propertyIndex=o}else c.fromArray!==void 0&&c.toArray!==void 0?(f=this.BindingType.HasFromToArray,this.resolvedProperty=c):Array.isArray(c)?(f=this.BindingType.EntireArray,this.resolvedProperty=c):this.propertyName=s;this.getValue=this.GetterByBindingType[f],this.setValue=this.SetterByBindingTypeAndVersioning[f][u]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};Bt.Composite=Kl;Bt.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};Bt.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};Bt.prototype.GetterByBindingType=[Bt.prototype._getValue_direct,Bt.prototype._getValue_array,Bt.prototype._getValue_arrayElement,Bt.prototype._getValue_toArray];Bt.prototype.SetterByBindingTypeAndVersioning=[[Bt.prototype._setValue_direct,Bt.prototype._setValue_direct_setNeedsUpdate,Bt.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[Bt.prototype._setValue_array,Bt.prototype._setValue_array_setNeedsUpdate,Bt.prototype._setValue_array_setMatrixWorldNeedsUpdate],[Bt.prototype._setValue_arrayElement,Bt.prototype._setValue_arrayElement_setNeedsUpdate,Bt.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[Bt.prototype._setValue_fromArray,Bt.prototype._setValue_fromArray_setNeedsUpdate,Bt.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var bb=new Float32Array(1);var fu=new Lt,Ds=class{constructor(e,t,n=0,s=1/0){this.ray=new Li(e,t),this.near=n,this.far=s,this.camera=null,this.layers=new Dr,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):tt("Raycaster: Unsupported camera type: "+t.type)}setFromXRController(e){return fu.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(fu),this}intersectObject(e,t=!0,n=[]){return Ql(e,this,n,t),n.sort(pu),n}intersectObjects(e,t=!0,n=[]){for(let s=0,o=e.length;s<o;s++)Ql(e[s],this,n,t);return n.sort(pu),n}};function pu(i,e){return i.distance-e.distance}function Ql(i,e,t,n){let s=!0;if(i.layers.test(e.layers)&&i.raycast(e,t)===!1&&(s=!1),s===!0&&n===!0){let o=i.children;for(let c=0,u=o.length;c<u;c++)Ql(o[c],e,t,!0)}}var kr=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=gt(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(gt(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var ec=class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,s){let o=this.elements;return o[0]=e,o[2]=t,o[1]=n,o[3]=s,this}};var Ls=class extends Vn{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Nc(i,e,t,n){let s=ev(n);switch(t){case xc:return i*e;case Mc:return i*e/s.components*s.byteLength;case yo:return i*e/s.components*s.byteLength;case Vi:return i*e*2/s.components*s.byteLength;case xo:return i*e*2/s.components*s.byteLength;case Sc:return i*e*3/s.components*s.byteLength;case qn:return i*e*4/s.components*s.byteLength;case So:return i*e*4/s.components*s.byteLength;case Us:case Os:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Bs:case ks:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case bo:case wo:return Math.max(i,16)*Math.max(e,8)/4;case Mo:case Eo:return Math.max(i,8)*Math.max(e,8)/2;case To:case Ao:case Co:case Po:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case Ro:case zs:case Io:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Do:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Lo:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case Fo:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case No:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case Uo:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case Oo:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case Bo:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case ko:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case zo:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case Go:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case Vo:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case Ho:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case Wo:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case Xo:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case $o:case qo:case Yo:return Math.ceil(i/4)*Math.ceil(e/4)*16;case jo:case Zo:return Math.ceil(i/4)*Math.ceil(e/4)*8;case Gs:case Jo:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function ev(i){switch(i){case bn:case gc:return{byteLength:1,components:1};case Hr:case _c:case $n:return{byteLength:2,components:1};case _o:case vo:return{byteLength:2,components:4};case Wn:case go:case Xn:return{byteLength:4,components:1};case vc:case yc:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Qe("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function wd(){let i=null,e=!1,t=null,n=null;function s(o,c){n=i.requestAnimationFrame(s),t(o,c)}return{start:function(){e!==!0&&t!==null&&i!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(o){t=o},setContext:function(o){i=o}}}function nv(i){let e=new WeakMap;function t(u,f){let d=u.array,m=u.usage,y=d.byteLength,g=i.createBuffer();i.bindBuffer(f,g),i.bufferData(f,d,m),u.onUploadCallback();let S;if(d instanceof Float32Array)S=i.FLOAT;else if(typeof Float16Array<"u"&&d instanceof Float16Array)S=i.HALF_FLOAT;else if(d instanceof Uint16Array)u.isFloat16BufferAttribute?S=i.HALF_FLOAT:S=i.UNSIGNED_SHORT;else if(d instanceof Int16Array)S=i.SHORT;else if(d instanceof Uint32Array)S=i.UNSIGNED_INT;else if(d instanceof Int32Array)S=i.INT;else if(d instanceof Int8Array)S=i.BYTE;else if(d instanceof Uint8Array)S=i.UNSIGNED_BYTE;else if(d instanceof Uint8ClampedArray)S=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+d);return{buffer:g,type:S,bytesPerElement:d.BYTES_PER_ELEMENT,version:u.version,size:y}}function n(u,f,d){let m=f.array,y=f.updateRanges;if(i.bindBuffer(d,u),y.length===0)i.bufferSubData(d,0,m);else{y.sort((S,E)=>S.start-E.start);let g=0;for(let S=1;S<y.length;S++){let E=y[g],C=y[S];C.start<=E.start+E.count+1?E.count=Math.max(E.count,C.start+C.count-E.start):(++g,y[g]=C)}y.length=g+1;for(let S=0,E=y.length;S<E;S++){let C=y[S];i.bufferSubData(d,C.start*m.BYTES_PER_ELEMENT,m,C.start,C.count)}f.clearUpdateRanges()}f.onUploadCallback()}function s(u){return u.isInterleavedBufferAttribute&&(u=u.data),e.get(u)}function o(u){u.isInterleavedBufferAttribute&&(u=u.data);let f=e.get(u);f&&(i.deleteBuffer(f.buffer),e.delete(u))}function c(u,f){if(u.isInterleavedBufferAttribute&&(u=u.data),u.isGLBufferAttribute){let m=e.get(u);(!m||m.version<u.version)&&e.set(u,{buffer:u.buffer,type:u.type,bytesPerElement:u.elementSize,version:u.version});return}let d=e.get(u);if(d===void 0)e.set(u,t(u,f));else if(d.version<u.version){if(d.size!==u.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(d.buffer,u,f),d.version=u.version}}return{get:s,remove:o,update:c}}var iv=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,rv=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,sv=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,av=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,ov=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,lv=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,cv=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,hv=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,uv=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,dv=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,fv=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,pv=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,mv=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,gv=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,_v=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,vv=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,yv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,xv=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,Sv=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Mv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,bv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,Ev=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,wv=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,Tv=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,Av=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Rv=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,Cv=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Pv=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Iv=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,Dv="gl_FragColor = linearToOutputTexel( gl_FragColor );",Lv=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Fv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,Nv=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,Uv=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,Ov=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,Bv=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,kv=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,zv=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Gv=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Vv=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Hv=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Wv=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Xv=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,$v=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,qv=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,Yv=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,jv=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Zv=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Jv=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Kv=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Qv=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,ey=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,ty=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,ny=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,iy=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,ry=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,sy=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,ay=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,oy=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,ly=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,cy=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,hy=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,uy=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,dy=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,fy=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,py=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,my=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,gy=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,_y=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,vy=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,yy=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,xy=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,Sy=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,My=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,by=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,Ey=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,wy=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,Ty=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,Ay=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,Ry=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,Cy=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,Py=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,Iy=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,Dy=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,Ly=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,Fy=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,Ny=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,Uy=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,Oy=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,By=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,ky=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,zy=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,Gy=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,Vy=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,Hy=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,Wy=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,Xy=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,$y=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,qy=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,Yy=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,jy=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,Zy=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,Jy=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,Ky=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,Qy=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,ex=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,tx=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,nx=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,ix=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,rx=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,sx=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,ax=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,ox=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,lx=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,cx=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,hx=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,ux=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,dx=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,fx=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,px=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,mx=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,gx=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,_x=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,vx=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,yx=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,xx=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,Sx=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,Mx=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,bx=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,Ex=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,wx=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,Tx=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,Ax=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,Rx=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,Cx=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,Px=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,Ix=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,Dx=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,Lx=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,Fx=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,Nx=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,mt={alphahash_fragment:iv,alphahash_pars_fragment:rv,alphamap_fragment:sv,alphamap_pars_fragment:av,alphatest_fragment:ov,alphatest_pars_fragment:lv,aomap_fragment:cv,aomap_pars_fragment:hv,batching_pars_vertex:uv,batching_vertex:dv,begin_vertex:fv,beginnormal_vertex:pv,bsdfs:mv,iridescence_fragment:gv,bumpmap_pars_fragment:_v,clipping_planes_fragment:vv,clipping_planes_pars_fragment:yv,clipping_planes_pars_vertex:xv,clipping_planes_vertex:Sv,color_fragment:Mv,color_pars_fragment:bv,color_pars_vertex:Ev,color_vertex:wv,common:Tv,defaultnormal_vertex:Av,displacementmap_pars_vertex:Rv,displacementmap_vertex:Cv,emissivemap_fragment:Pv,emissivemap_pars_fragment:Iv,colorspace_fragment:Dv,colorspace_pars_fragment:Lv,envmap_fragment:Fv,envmap_common_pars_fragment:Nv,envmap_pars_fragment:Uv,envmap_pars_vertex:Ov,envmap_physical_pars_fragment:Yv,envmap_vertex:Bv,fog_vertex:kv,fog_pars_vertex:zv,fog_fragment:Gv,fog_pars_fragment:Vv,gradientmap_pars_fragment:Hv,lightmap_pars_fragment:Wv,lights_lambert_fragment:Xv,lights_lambert_pars_fragment:$v,lights_pars_begin:qv,lights_toon_fragment:jv,lights_toon_pars_fragment:Zv,lights_phong_fragment:Jv,lights_phong_pars_fragment:Kv,lights_physical_fragment:Qv,lights_physical_pars_fragment:ey,lights_fragment_begin:ty,lights_fragment_maps:ny,lights_fragment_end:iy,lightprobes_pars_fragment:ry,logdepthbuf_fragment:sy,logdepthbuf_pars_fragment:ay,logdepthbuf_pars_vertex:oy,logdepthbuf_vertex:ly,map_fragment:cy,map_pars_fragment:hy,map_particle_fragment:uy,map_particle_pars_fragment:dy,metalnessmap_fragment:fy,metalnessmap_pars_fragment:py,morphinstance_vertex:my,morphcolor_vertex:gy,morphnormal_vertex:_y,morphtarget_pars_vertex:vy,morphtarget_vertex:yy,normal_fragment_begin:xy,normal_fragment_maps:Sy,normal_pars_fragment:My,normal_pars_vertex:by,normal_vertex:Ey,normalmap_pars_fragment:wy,clearcoat_normal_fragment_begin:Ty,clearcoat_normal_fragment_maps:Ay,clearcoat_pars_fragment:Ry,iridescence_pars_fragment:Cy,opaque_fragment:Py,packing:Iy,premultiplied_alpha_fragment:Dy,project_vertex:Ly,dithering_fragment:Fy,dithering_pars_fragment:Ny,roughnessmap_fragment:Uy,roughnessmap_pars_fragment:Oy,shadowmap_pars_fragment:By,shadowmap_pars_vertex:ky,shadowmap_vertex:zy,shadowmask_pars_fragment:Gy,skinbase_vertex:Vy,skinning_pars_vertex:Hy,skinning_vertex:Wy,skinnormal_vertex:Xy,specularmap_fragment:$y,specularmap_pars_fragment:qy,tonemapping_fragment:Yy,tonemapping_pars_fragment:jy,transmission_fragment:Zy,transmission_pars_fragment:Jy,uv_pars_fragment:Ky,uv_pars_vertex:Qy,uv_vertex:ex,worldpos_vertex:tx,background_vert:nx,background_frag:ix,backgroundCube_vert:rx,backgroundCube_frag:sx,cube_vert:ax,cube_frag:ox,depth_vert:lx,depth_frag:cx,distance_vert:hx,distance_frag:ux,equirect_vert:dx,equirect_frag:fx,linedashed_vert:px,linedashed_frag:mx,meshbasic_vert:gx,meshbasic_frag:_x,meshlambert_vert:vx,meshlambert_frag:yx,meshmatcap_vert:xx,meshmatcap_frag:Sx,meshnormal_vert:Mx,meshnormal_frag:bx,meshphong_vert:Ex,meshphong_frag:wx,meshphysical_vert:Tx,meshphysical_frag:Ax,meshtoon_vert:Rx,meshtoon_frag:Cx,points_vert:Px,points_frag:Ix,shadow_vert:Dx,shadow_frag:Lx,sprite_vert:Fx,sprite_frag:Nx},Be={common:{diffuse:{value:new ct(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new at},alphaMap:{value:null},alphaMapTransform:{value:new at},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new at}},envmap:{envMap:{value:null},envMapRotation:{value:new at},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new at}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new at}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new at},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new at},normalScale:{value:new et(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new at},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new at}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new at}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new at}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new ct(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new ct(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new at},alphaTest:{value:0},uvTransform:{value:new at}},sprite:{diffuse:{value:new ct(16777215)},opacity:{value:1},center:{value:new et(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new at},alphaMap:{value:null},alphaMapTransform:{value:new at},alphaTest:{value:0}}},ui={basic:{uniforms:fn([Be.common,Be.specularmap,Be.envmap,Be.aomap,Be.lightmap,Be.fog]),vertexShader:mt.meshbasic_vert,fragmentShader:mt.meshbasic_frag},lambert:{uniforms:fn([Be.common,Be.specularmap,Be.envmap,Be.aomap,Be.lightmap,Be.emissivemap,Be.bumpmap,Be.normalmap,Be.displacementmap,Be.fog,Be.lights,{emissive:{value:new ct(0)},envMapIntensity:{value:1}}]),vertexShader:mt.meshlambert_vert,fragmentShader:mt.meshlambert_frag},phong:{uniforms:fn([Be.common,Be.specularmap,Be.envmap,Be.aomap,Be.lightmap,Be.emissivemap,Be.bumpmap,Be.normalmap,Be.displacementmap,Be.fog,Be.lights,{emissive:{value:new ct(0)},specular:{value:new ct(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:mt.meshphong_vert,fragmentShader:mt.meshphong_frag},standard:{uniforms:fn([Be.common,Be.envmap,Be.aomap,Be.lightmap,Be.emissivemap,Be.bumpmap,Be.normalmap,Be.displacementmap,Be.roughnessmap,Be.metalnessmap,Be.fog,Be.lights,{emissive:{value:new ct(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:mt.meshphysical_vert,fragmentShader:mt.meshphysical_frag},toon:{uniforms:fn([Be.common,Be.aomap,Be.lightmap,Be.emissivemap,Be.bumpmap,Be.normalmap,Be.displacementmap,Be.gradientmap,Be.fog,Be.lights,{emissive:{value:new ct(0)}}]),vertexShader:mt.meshtoon_vert,fragmentShader:mt.meshtoon_frag},matcap:{uniforms:fn([Be.common,Be.bumpmap,Be.normalmap,Be.displacementmap,Be.fog,{matcap:{value:null}}]),vertexShader:mt.meshmatcap_vert,fragmentShader:mt.meshmatcap_frag},points:{uniforms:fn([Be.points,Be.fog]),vertexShader:mt.points_vert,fragmentShader:mt.points_frag},dashed:{uniforms:fn([Be.common,Be.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:mt.linedashed_vert,fragmentShader:mt.linedashed_frag},depth:{uniforms:fn([Be.common,Be.displacementmap]),vertexShader:mt.depth_vert,fragmentShader:mt.depth_frag},normal:{uniforms:fn([Be.common,Be.bumpmap,Be.normalmap,Be.displacementmap,{opacity:{value:1}}]),vertexShader:mt.meshnormal_vert,fragmentShader:mt.meshnormal_frag},sprite:{uniforms:fn([Be.sprite,Be.fog]),vertexShader:mt.sprite_vert,fragmentShader:mt.sprite_frag},background:{uniforms:{uvTransform:{value:new at},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:mt.background_vert,fragmentShader:mt.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new at}},vertexShader:mt.backgroundCube_vert,fragmentShader:mt.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:mt.cube_vert,fragmentShader:mt.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:mt.equirect_vert,fragmentShader:mt.equirect_frag},distance:{uniforms:fn([Be.common,Be.displacementmap,{referencePosition:{value:new j},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:mt.distance_vert,fragmentShader:mt.distance_frag},shadow:{uniforms:fn([Be.lights,Be.fog,{color:{value:new ct(0)},opacity:{value:1}}]),vertexShader:mt.shadow_vert,fragmentShader:mt.shadow_frag}};ui.physical={uniforms:fn([ui.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new at},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new at},clearcoatNormalScale:{value:new et(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new at},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new at},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new at},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new at},sheen:{value:0},sheenColor:{value:new ct(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new at},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new at},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new at},transmissionSamplerSize:{value:new et},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new at},attenuationDistance:{value:0},attenuationColor:{value:new ct(0)},specularColor:{value:new ct(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new at},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new at},anisotropyVector:{value:new et},anisotropyMap:{value:null},anisotropyMapTransform:{value:new at}}]),vertexShader:mt.meshphysical_vert,fragmentShader:mt.meshphysical_frag};var Qo={r:0,b:0,g:0},Ux=new Lt,Td=new at;Td.set(-1,0,0,0,1,0,0,0,1);function Ox(i,e,t,n,s,o){let c=new ct(0),u=s===!0?0:1,f,d,m=null,y=0,g=null;function S(P){let O=P.isScene===!0?P.background:null;if(O&&O.isTexture){let I=P.backgroundBlurriness>0;O=e.get(O,I)}return O}function E(P){let O=!1,I=S(P);I===null?x(c,u):I&&I.isColor&&(x(I,1),O=!0);let U=i.xr.getEnvironmentBlendMode();U==="additive"?t.buffers.color.setClear(0,0,0,1,o):U==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,o),(i.autoClear||O)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function C(P,O){let I=S(O);I&&I.isCubeTexture?(d===void 0&&(d=new Mn(new Ni(1,1,1),new oi({name:"BackgroundCubeMaterial",uniforms:or(ui.backgroundCube.uniforms),vertexShader:ui.backgroundCube.vertexShader,fragmentShader:ui.backgroundCube.fragmentShader,side:xn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),d.geometry.deleteAttribute("normal"),d.geometry.deleteAttribute("uv"),d.onBeforeRender=function(U,N,b){this.matrixWorld.copyPosition(b.matrixWorld)},Object.defineProperty(d.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(d)),d.material.uniforms.envMap.value=I,d.material.uniforms.backgroundBlurriness.value=O.backgroundBlurriness,d.material.uniforms.backgroundIntensity.value=O.backgroundIntensity,d.material.uniforms.backgroundRotation.value.setFromMatrix4(Ux.makeRotationFromEuler(O.backgroundRotation)).transpose(),I.isRenderTargetTexture===!1&&d.material.uniforms.backgroundRotation.value.premultiply(Td),d.material.toneMapped=yt.getTransfer(I.colorSpace)!==Rt,(m!==I||y!==I.version||g!==i.toneMapping)&&(d.material.needsUpdate=!0,m=I,y=I.version,g=i.toneMapping),d.layers.enableAll(),P.unshift(d,d.geometry,d.material,0,0,null)):I&&I.isTexture&&(f===void 0&&(f=new Mn(new bs(2,2),new oi({name:"BackgroundMaterial",uniforms:or(ui.background.uniforms),vertexShader:ui.background.vertexShader,fragmentShader:ui.background.fragmentShader,side:Gi,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),f.geometry.deleteAttribute("normal"),Object.defineProperty(f.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(f)),f.material.uniforms.t2D.value=I,f.material.uniforms.backgroundIntensity.value=O.backgroundIntensity,f.material.toneMapped=yt.getTransfer(I.colorSpace)!==Rt,I.matrixAutoUpdate===!0&&I.updateMatrix(),f.material.uniforms.uvTransform.value.copy(I.matrix),(m!==I||y!==I.version||g!==i.toneMapping)&&(f.material.needsUpdate=!0,m=I,y=I.version,g=i.toneMapping),f.layers.enableAll(),P.unshift(f,f.geometry,f.material,0,0,null))}function x(P,O){P.getRGB(Qo,Dc(i)),t.buffers.color.setClear(Qo.r,Qo.g,Qo.b,O,o)}function v(){d!==void 0&&(d.geometry.dispose(),d.material.dispose(),d=void 0),f!==void 0&&(f.geometry.dispose(),f.material.dispose(),f=void 0)}return{getClearColor:function(){return c},setClearColor:function(P,O=1){c.set(P),u=O,x(c,u)},getClearAlpha:function(){return u},setClearAlpha:function(P){u=P,x(c,u)},render:E,addToRenderList:C,dispose:v}}function Bx(i,e){let t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=g(null),o=s,c=!1;function u(Y,J,ee,z,ie){let G=!1,ne=y(Y,z,ee,J);o!==ne&&(o=ne,d(o.object)),G=S(Y,z,ee,ie),G&&E(Y,z,ee,ie),ie!==null&&e.update(ie,i.ELEMENT_ARRAY_BUFFER),(G||c)&&(c=!1,I(Y,J,ee,z),ie!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(ie).buffer))}function f(){return i.createVertexArray()}function d(Y){return i.bindVertexArray(Y)}function m(Y){return i.deleteVertexArray(Y)}function y(Y,J,ee,z){let ie=z.wireframe===!0,G=n[J.id];G===void 0&&(G={},n[J.id]=G);let ne=Y.isInstancedMesh===!0?Y.id:0,Se=G[ne];Se===void 0&&(Se={},G[ne]=Se);let re=Se[ee.id];re===void 0&&(re={},Se[ee.id]=re);let H=re[ie];return H===void 0&&(H=g(f()),re[ie]=H),H}function g(Y){let J=[],ee=[],z=[];for(let ie=0;ie<t;ie++)J[ie]=0,ee[ie]=0,z[ie]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:J,enabledAttributes:ee,attributeDivisors:z,object:Y,attributes:{},index:null}}function S(Y,J,ee,z){let ie=o.attributes,G=J.attributes,ne=0,Se=ee.getAttributes();for(let re in Se)if(Se[re].location>=0){let me=ie[re],We=G[re];if(We===void 0&&(re==="instanceMatrix"&&Y.instanceMatrix&&(We=Y.instanceMatrix),re==="instanceColor"&&Y.instanceColor&&(We=Y.instanceColor)),me===void 0||me.attribute!==We||We&&me.data!==We.data)return!0;ne++}return o.attributesNum!==ne||o.index!==z}function E(Y,J,ee,z){let ie={},G=J.attributes,ne=0,Se=ee.getAttributes();for(let re in Se)if(Se[re].location>=0){let me=G[re];me===void 0&&(re==="instanceMatrix"&&Y.instanceMatrix&&(me=Y.instanceMatrix),re==="instanceColor"&&Y.instanceColor&&(me=Y.instanceColor));let We={};We.attribute=me,me&&me.data&&(We.data=me.data),ie[re]=We,ne++}o.attributes=ie,o.attributesNum=ne,o.index=z}function C(){let Y=o.newAttributes;for(let J=0,ee=Y.length;J<ee;J++)Y[J]=0}function x(Y){v(Y,0)}function v(Y,J){let ee=o.newAttributes,z=o.enabledAttributes,ie=o.attributeDivisors;ee[Y]=1,z[Y]===0&&(i.enableVertexAttribArray(Y),z[Y]=1),ie[Y]!==J&&(i.vertexAttribDivisor(Y,J),ie[Y]=J)}function P(){let Y=o.newAttributes,J=o.enabledAttributes;for(let ee=0,z=J.length;ee<z;ee++)J[ee]!==Y[ee]&&(i.disableVertexAttribArray(ee),J[ee]=0)}function O(Y,J,ee,z,ie,G,ne){ne===!0?i.vertexAttribIPointer(Y,J,ee,ie,G):i.vertexAttribPointer(Y,J,ee,z,ie,G)}function I(Y,J,ee,z){C();let ie=z.attributes,G=ee.getAttributes(),ne=J.defaultAttributeValues;for(let Se in G){let re=G[Se];if(re.location>=0){let H=ie[Se];if(H===void 0&&(Se==="instanceMatrix"&&Y.instanceMatrix&&(H=Y.instanceMatrix),Se==="instanceColor"&&Y.instanceColor&&(H=Y.instanceColor)),H!==void 0){let me=H.normalized,We=H.itemSize,nt=e.get(H);if(nt===void 0)continue;let ue=nt.buffer,Fe=nt.type,Pe=nt.bytesPerElement,Ye=Fe===i.INT||Fe===i.UNSIGNED_INT||H.gpuType===go;if(H.isInterleavedBufferAttribute){let Ue=H.data,rt=Ue.isInterleavedBuffer===!0?Ue.stride:Ue.itemSize,Gt=H.offset;if(Ue.isInstancedInterleavedBuffer||Ue.isInstancedBufferAttribute){for(let Ke=0;Ke<re.locationSize;Ke++)v(re.location+Ke,Ue.meshPerAttribute);Y.isInstancedMesh!==!0&&z._maxInstanceCount===void 0&&(z._maxInstanceCount=Ue.meshPerAttribute*Ue.count)}else for(let Ke=0;Ke<re.locationSize;Ke++)x(re.location+Ke);i.bindBuffer(i.ARRAY_BUFFER,ue);for(let Ke=0;Ke<re.locationSize;Ke++)O(re.location+Ke,We/re.locationSize,Fe,me,rt*Pe,(Gt+We/re.locationSize*Ke)*Pe,Ye)}else{if(H.isInstancedBufferAttribute){for(let Ue=0;Ue<re.locationSize;Ue++)v(re.location+Ue,H.meshPerAttribute);Y.isInstancedMesh!==!0&&z._maxInstanceCount===void 0&&(z._maxInstanceCount=H.meshPerAttribute*H.count)}else for(let Ue=0;Ue<re.locationSize;Ue++)x(re.location+Ue);i.bindBuffer(i.ARRAY_BUFFER,ue);for(let Ue=0;Ue<re.locationSize;Ue++)O(re.location+Ue,We/re.locationSize,Fe,me,We*Pe,We/re.locationSize*Ue*Pe,Ye)}}else if(ne!==void 0){let me=ne[Se];if(me!==void 0)switch(me.length){case 2:i.vertexAttrib2fv(re.location,me);break;case 3:i.vertexAttrib3fv(re.location,me);break;case 4:i.vertexAttrib4fv(re.location,me);break;default:i.vertexAttrib1fv(re.location,me)}}}}P()}function U(){q();for(let Y in n){let J=n[Y];for(let ee in J){let z=J[ee];for(let ie in z){let G=z[ie];for(let ne in G)m(G[ne].object),delete G[ne];delete z[ie]}}delete n[Y]}}function N(Y){if(n[Y.id]===void 0)return;let J=n[Y.id];for(let ee in J){let z=J[ee];for(let ie in z){let G=z[ie];for(let ne in G)m(G[ne].object),delete G[ne];delete z[ie]}}delete n[Y.id]}function b(Y){for(let J in n){let ee=n[J];for(let z in ee){let ie=ee[z];if(ie[Y.id]===void 0)continue;let G=ie[Y.id];for(let ne in G)m(G[ne].object),delete G[ne];delete ie[Y.id]}}}function D(Y){for(let J in n){let ee=n[J],z=Y.isInstancedMesh===!0?Y.id:0,ie=ee[z];if(ie!==void 0){for(let G in ie){let ne=ie[G];for(let Se in ne)m(ne[Se].object),delete ne[Se];delete ie[G]}delete ee[z],Object.keys(ee).length===0&&delete n[J]}}}function q(){k(),c=!0,o!==s&&(o=s,d(o.object))}function k(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:u,reset:q,resetDefaultState:k,dispose:U,releaseStatesOfGeometry:N,releaseStatesOfObject:D,releaseStatesOfProgram:b,initAttributes:C,enableAttribute:x,disableUnusedAttributes:P}}function kx(i,e,t){let n;function s(f){n=f}function o(f,d){i.drawArrays(n,f,d),t.update(d,n,1)}function c(f,d,m){m!==0&&(i.drawArraysInstanced(n,f,d,m),t.update(d,n,m))}function u(f,d,m){if(m===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,f,0,d,0,m);let g=0;for(let S=0;S<m;S++)g+=d[S];t.update(g,n,1)}this.setMode=s,this.render=o,this.renderInstances=c,this.renderMultiDraw=u}function zx(i,e,t,n){let s;function o(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let b=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(b.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function c(b){return!(b!==qn&&n.convert(b)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function u(b){let D=b===$n&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(b!==bn&&b!==Xn&&!D&&n.convert(b)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function f(b){if(b==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";b="mediump"}return b==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let d=t.precision!==void 0?t.precision:"highp",m=f(d);m!==d&&(Qe("WebGLRenderer:",d,"not supported, using",m,"instead."),d=m);let y=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),g=t.logarithmicDepthBuffer===!0&&y===!1;t.reversedDepthBuffer===!0&&y===!1&&Qe("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&y===!0&&Qe("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let S=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),E=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),C=i.getParameter(i.MAX_TEXTURE_SIZE),x=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),v=i.getParameter(i.MAX_VERTEX_ATTRIBS),P=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),O=i.getParameter(i.MAX_VARYING_VECTORS),I=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),U=i.getParameter(i.MAX_SAMPLES),N=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:o,getMaxPrecision:f,textureFormatReadable:c,textureTypeReadable:u,precision:d,logarithmicDepthBuffer:g,reversedDepthBuffer:y,maxTextures:S,maxVertexTextures:E,maxTextureSize:C,maxCubemapSize:x,maxAttributes:v,maxVertexUniforms:P,maxVaryings:O,maxFragmentUniforms:I,maxSamples:U,samples:N}}function Gx(i){let e=this,t=null,n=0,s=!1,o=!1,c=new gn,u=new at,f={value:null,needsUpdate:!1};this.uniform=f,this.numPlanes=0,this.numIntersection=0,this.init=function(y,g){let S=y.length!==0||g||n!==0||s;return s=g,n=y.length,S},this.beginShadows=function(){o=!0,m(null)},this.endShadows=function(){o=!1},this.setGlobalState=function(y,g){t=m(y,g,0)},this.setState=function(y,g,S){let E=y.clippingPlanes,C=y.clipIntersection,x=y.clipShadows,v=i.get(y);if(!s||E===null||E.length===0||o&&!x)o?m(null):d();else{let P=o?0:n,O=P*4,I=v.clippingState||null;f.value=I,I=m(E,g,O,S);for(let U=0;U!==O;++U)I[U]=t[U];v.clippingState=I,this.numIntersection=C?this.numPlanes:0,this.numPlanes+=P}};function d(){f.value!==t&&(f.value=t,f.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function m(y,g,S,E){let C=y!==null?y.length:0,x=null;if(C!==0){if(x=f.value,E!==!0||x===null){let v=S+C*4,P=g.matrixWorldInverse;u.getNormalMatrix(P),(x===null||x.length<v)&&(x=new Float32Array(v));for(let O=0,I=S;O!==C;++O,I+=4)c.copy(y[O]).applyMatrix4(P,u),c.normal.toArray(x,I),x[I+3]=c.constant}f.value=x,f.needsUpdate=!0}return e.numPlanes=C,e.numIntersection=0,x}}var Ws=class extends Cn{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new _s(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new Ni(5,5,5),o=new oi({name:"CubemapFromEquirect",uniforms:or(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:xn,blending:ir});o.uniforms.tEquirect.value=t;let c=new Mn(s,o),u=t.minFilter;return t.minFilter===Hn&&(t.minFilter=vn),new Br(1,10,this).update(e,c),t.minFilter=u,c.geometry.dispose(),c.material.dispose(),this}clear(e,t=!0,n=!0,s=!0){let o=e.getRenderTarget();for(let c=0;c<6;c++)e.setRenderTarget(this,c),e.clear(t,n,s);e.setRenderTarget(o)}},rd=256,Vx=3,Hx=20,Ad=256,Rd=16,Wx=3,Xx=new j,$x=new ct,tl=class i{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new Br(1,10,null),this._boxMesh=new Mn(new Ni(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,s=100,o={}){let{size:c=256,position:u=Xx}=o,f=this._renderer;this._setSize(c);let d=this._allocateTarget(),m=this._getSourceTarget(!0);t>0&&(m.texture.mipmapsAutoUpdate=!1);let y=f.autoClear,g=f.autoClearColor,S=f.autoClearDepth,E=f.autoClearStencil,C=e.background;f.autoClear=!0,f.autoClearColor=!0,f.autoClearDepth=!0,f.autoClearStencil=!0,C===null&&(e.background=f.getClearColor($x));let x=new Br(n,s,m);return x.position.copy(u),x.update(f,e),f.autoClear=y,f.autoClearColor=g,f.autoClearDepth=S,f.autoClearStencil=E,e.background=C,t>0&&(m.texture.mipmapsAutoUpdate=!0,this._blur(d,t)),this._applyPMREM(d),d}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=od(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=ad(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(rd,Cc(e))}_fromTexture(e,t){e.mapping===sr||e.mapping===Vr?this._setSize(e.image.length===0?rd:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=sd(e,!1,!1),n=Math.log2(e)-Vx;for(let s=0;s<=n;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=sd(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let s=this._boxMesh,o=this._cubeCamera;s.material=n,o.renderTarget=e,o.activeMipmapLevel=t;let c=e.width>>t;e.viewport.set(0,0,c,c),o.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===sr||e.mapping===Vr?(this._cubemapMaterial===null&&(this._cubemapMaterial=od()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=ad()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=qx(),this._integrationMaterial=Yx());let t=this._cubeSize,n=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let o=this._integrationMaterial.uniforms;o.envMap.value=this._sourceTarget.texture,o.sourceLod.value=Math.log2(t/Rd);for(let c=0;c<=n;c++){let u=i.lodToRoughness(c,n);if(c>n-Wx)o.roughness.value=u,this._renderCube(e,c,this._integrationMaterial);else{let f=u>0?Math.log2(t)+.5*Math.log2(6/(Ad*Math.pow(u,4)))+.5:0;s.roughness.value=u,s.lodBias.value=f,this._renderCube(e,c,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=jx());let n=this._blurMaterial,s=n.uniforms,o=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=o.texture,this._renderCube(e,0,n),s.envMap.value=e.texture,this._renderCube(o,0,n)}};function sd(i,e,t){return new Ws(i,{minFilter:Hn,generateMipmaps:e,type:$n,colorSpace:ls,depthBuffer:t})}function Xs(i,e,t){return new oi({name:i,uniforms:e,vertexShader:mt.cube_vert,fragmentShader:t,side:xn,blending:ir,depthTest:!1,depthWrite:!1})}function qx(){return Xs("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Ad}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Yx(){return Xs("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Rd}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function jx(){return Xs("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${Hx}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function ad(){return Xs("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function od(){return Xs("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function Zx(i){let e=new WeakMap,t=new WeakMap,n=null;function s(g,S=!1){return g==null?null:S?c(g):o(g)}function o(g){if(g&&g.isTexture){let S=g.mapping;if(S===fo||S===po)if(e.has(g)){let E=e.get(g).texture;return u(E,g.mapping)}else{let E=g.image;if(E&&E.height>0){let C=new Ws(E.height);return C.fromEquirectangularTexture(i,g),e.set(g,C),g.addEventListener("dispose",d),u(C.texture,g.mapping)}else return null}}return g}function c(g){if(g&&g.isTexture&&g.isPMREMTexture!==!0){let S=g.mapping,E=S===fo||S===po,C=S===sr||S===Vr;if(E||C){let x=t.get(g),v=x!==void 0?x.texture.pmremVersion:0;if(g.isRenderTargetTexture&&g.pmremVersion!==v)return n===null&&(n=new tl(i)),x=E?n.fromEquirectangular(g,x):n.fromCubemap(g,x),x.texture.pmremVersion=g.pmremVersion,t.set(g,x),x.texture;if(x!==void 0)return x.texture;{let P=g.image;return E&&P&&P.height>0||C&&P&&f(P)?(n===null&&(n=new tl(i)),x=E?n.fromEquirectangular(g):n.fromCubemap(g),x.texture.pmremVersion=g.pmremVersion,t.set(g,x),g.addEventListener("dispose",m),x.texture):null}}}return g}function u(g,S){return S===fo?g.mapping=sr:S===po&&(g.mapping=Vr),g}function f(g){let S=0,E=6;for(let C=0;C<E;C++)g[C]!==void 0&&S++;return S===E}function d(g){let S=g.target;S.removeEventListener("dispose",d);let E=e.get(S);E!==void 0&&(e.delete(S),E.dispose())}function m(g){let S=g.target;S.removeEventListener("dispose",m);let E=t.get(S);E!==void 0&&(t.delete(S),E.dispose())}function y(){e=new WeakMap,t=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:y}}function Jx(i){let e={};function t(n){if(e[n]!==void 0)return e[n];let s=i.getExtension(n);return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){let s=t(n);return s===null&&rs("WebGLRenderer: "+n+" extension not supported."),s}}}function Kx(i,e,t,n){let s={},o=new WeakMap,c=new FinalizationRegistry(E=>delete s[E]);function u(E){f(E.target)}function f(E){E.index!==null&&e.remove(E.index);for(let x in E.attributes)e.remove(E.attributes[x]);E.removeEventListener("dispose",u),delete s[E.id],c.unregister(E);let C=o.get(E);C&&(e.remove(C),o.delete(E)),n.releaseStatesOfGeometry(E),E.isInstancedBufferGeometry===!0&&delete E._maxInstanceCount,t.memory.geometries--}function d(E,C){return s[C.id]!==void 0||(C.addEventListener("dispose",u),s[C.id]=new WeakRef(C),c.register(C,C.id,C),t.memory.geometries++),C}function m(E){let C=E.attributes;for(let x in C)e.update(C[x],i.ARRAY_BUFFER)}function y(E){let C=E.index,x=E.attributes.position,v=0;if(x===void 0)return;let P=C!==null?C.array.length:x.array.length/3-1,O=x.count>=65535?ms:ps,I=new O(Math.ceil(P/3)*6,1),U=I.array;if(C!==null){let b=C.array;v=C.version;for(let D=0,q=0;D<P;D+=3){let k=b[D+0],Y=b[D+1],J=b[D+2];U[q++]=k,U[q++]=Y,U[q++]=Y,U[q++]=J,U[q++]=J,U[q++]=k}}else{v=x.version;for(let b=0,D=0;b<P;b+=3){let q=b+0,k=b+1,Y=b+2;U[D++]=q,U[D++]=k,U[D++]=k,U[D++]=Y,U[D++]=Y,U[D++]=q}}I.version=v;let N=o.get(E);N&&e.remove(N),o.set(E,I)}function g(E){let C=o.get(E);if(C){let x=E.index;x!==null&&C.version<x.version&&y(E)}else y(E);return o.get(E)}function S(){for(let E in s){let C=s[E].deref();C!==void 0&&f(C)}}return{get:d,update:m,getWireframeAttribute:g,dispose:S}}function Qx(i,e,t){let n;function s(y){n=y}let o,c;function u(y){o=y.type,c=y.bytesPerElement}function f(y,g){i.drawElements(n,g,o,y*c),t.update(g,n,1)}function d(y,g,S){S!==0&&(i.drawElementsInstanced(n,g,o,y*c,S),t.update(g,n,S))}function m(y,g,S){if(S===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,g,0,o,y,0,S);let C=0;for(let x=0;x<S;x++)C+=g[x];t.update(C,n,1)}this.setMode=s,this.setIndex=u,this.render=f,this.renderInstances=d,this.renderMultiDraw=m}function eS(i){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(o,c,u){switch(t.calls++,c){case i.TRIANGLES:t.triangles+=u*(o/3);break;case i.LINES:t.lines+=u*(o/2);break;case i.LINE_STRIP:t.lines+=u*(o-1);break;case i.LINE_LOOP:t.lines+=u*o;break;case i.POINTS:t.points+=u*o;break;default:tt("WebGLInfo: Unknown draw mode:",c);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function tS(i,e,t){let n=new WeakMap,s=new zt;function o(c,u,f){let d=c.morphTargetInfluences,m=u.morphAttributes.position||u.morphAttributes.normal||u.morphAttributes.color,y=m!==void 0?m.length:0,g=n.get(u);if(g===void 0||g.count!==y){let q=function(){b.dispose(),n.delete(u),u.removeEventListener("dispose",q)};g!==void 0&&g.texture.dispose();let S=u.morphAttributes.position!==void 0,E=u.morphAttributes.normal!==void 0,C=u.morphAttributes.color!==void 0,x=u.morphAttributes.position||[],v=u.morphAttributes.normal||[],P=u.morphAttributes.color||[],O=0;S===!0&&(O=1),E===!0&&(O=2),C===!0&&(O=3);let I=u.attributes.position.count*O,U=1;I>e.maxTextureSize&&(U=Math.ceil(I/e.maxTextureSize),I=e.maxTextureSize);let N=new Float32Array(I*U*4*y),b=new us(N,I,U,y);b.type=Xn,b.needsUpdate=!0;let D=O*4;for(let k=0;k<y;k++){let Y=x[k],J=v[k],ee=P[k],z=I*U*4*k;for(let ie=0;ie<Y.count;ie++){let G=ie*D;S===!0&&(s.fromBufferAttribute(Y,ie),N[z+G+0]=s.x,N[z+G+1]=s.y,N[z+G+2]=s.z,N[z+G+3]=0),E===!0&&(s.fromBufferAttribute(J,ie),N[z+G+4]=s.x,N[z+G+5]=s.y,N[z+G+6]=s.z,N[z+G+7]=0),C===!0&&(s.fromBufferAttribute(ee,ie),N[z+G+8]=s.x,N[z+G+9]=s.y,N[z+G+10]=s.z,N[z+G+11]=ee.itemSize===4?s.w:1)}}g={count:y,texture:b,size:new et(I,U)},n.set(u,g),u.addEventListener("dispose",q)}if(c.isInstancedMesh===!0&&c.morphTexture!==null)f.getUniforms().setValue(i,"morphTexture",c.morphTexture,t);else{let S=0;for(let C=0;C<d.length;C++)S+=d[C];let E=u.morphTargetsRelative?1:1-S;f.getUniforms().setValue(i,"morphTargetBaseInfluence",E),f.getUniforms().setValue(i,"morphTargetInfluences",d)}f.getUniforms().setValue(i,"morphTargetsTexture",g.texture,t),f.getUniforms().setValue(i,"morphTargetsTextureSize",g.size)}return{update:o}}function nS(i,e,t,n,s){let o=new WeakMap;function c(d){let m=s.render.frame,y=d.geometry,g=e.get(d,y);if(o.get(g)!==m&&(e.update(g),o.set(g,m)),d.isInstancedMesh&&(d.hasEventListener("dispose",f)===!1&&d.addEventListener("dispose",f),o.get(d)!==m&&(t.update(d.instanceMatrix,i.ARRAY_BUFFER),d.instanceColor!==null&&t.update(d.instanceColor,i.ARRAY_BUFFER),o.set(d,m))),d.isSkinnedMesh){let S=d.skeleton;o.get(S)!==m&&(S.update(),o.set(S,m))}return g}function u(){o=new WeakMap}function f(d){let m=d.target;m.removeEventListener("dispose",f),n.releaseStatesOfObject(m),t.remove(m.instanceMatrix),m.instanceColor!==null&&t.remove(m.instanceColor)}return{update:c,dispose:u}}var iS={[lc]:"LINEAR_TONE_MAPPING",[cc]:"REINHARD_TONE_MAPPING",[hc]:"CINEON_TONE_MAPPING",[uc]:"ACES_FILMIC_TONE_MAPPING",[fc]:"AGX_TONE_MAPPING",[pc]:"NEUTRAL_TONE_MAPPING",[dc]:"CUSTOM_TONE_MAPPING"};function rS(i,e,t,n,s,o){let c=new Cn(e,t,{type:i,depthBuffer:s,stencilBuffer:o,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),u=null,f=null,d=null,m=new yn;m.setAttribute("position",new kt([-1,3,0,-1,-1,0,3,-1,0],3)),m.setAttribute("uv",new kt([0,2,0,0,2,0],2));let y=new Ja({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),g=new Mn(m,y),S=new Ps(-1,1,1,-1,0,1),E=null,C=null,x=!1,v,P=null,O=[],I=!1;this.setSize=function(U,N){c.setSize(U,N),u!==null&&u.setSize(U,N),f!==null&&f.setSize(U,N);for(let b=0;b<O.length;b++){let D=O[b];D.setSize&&D.setSize(U,N)}},this.setEffects=function(U){O=U,I=O.length>0&&O[0].isRenderPass===!0;let N=c.width,b=c.height;O.length>0&&u===null&&(u=new Cn(N,b,{type:$n,depthBuffer:!1,stencilBuffer:!1}),f=new Cn(N,b,{type:$n,depthBuffer:!1,stencilBuffer:!1}));let D=s===!0&&O.some(q=>q.needsDepthTexture===!0);D!==(c.depthTexture!==null)&&(D===!0&&d===null&&(d=new Mi(N,b),o===!0&&(d.format=bi,d.type=ar)),c.dispose(),c.depthTexture=D?d:null,c.resolveDepthBuffer=D,c.storeMultisampledDepthBuffer=D);for(let q=0;q<O.length;q++){let k=O[q];k.setSize&&k.setSize(N,b),D&&k.needsDepthTexture===!0&&k.setDepthTexture&&k.setDepthTexture(d)}},this.begin=function(U,N){if(x||U.toneMapping===ci&&O.length===0)return!1;if(P=N,N!==null){let b=N.width,D=N.height;(c.width!==b||c.height!==D)&&this.setSize(b,D)}return I===!1&&U.setRenderTarget(c),v=U.toneMapping,U.toneMapping=ci,!0},this.hasRenderPass=function(){return I},this.end=function(U,N){U.toneMapping=v,x=!0;let b=c,D=u;for(let q=0;q<O.length;q++){let k=O[q];k.enabled!==!1&&(k.render(U,D,b,N),k.needsSwap!==!1&&(b=D,D=D===u?f:u))}if(E!==U.outputColorSpace||C!==U.toneMapping){E=U.outputColorSpace,C=U.toneMapping,y.defines={},yt.getTransfer(E)===Rt&&(y.defines.SRGB_TRANSFER="");let q=iS[C];q&&(y.defines[q]=""),y.needsUpdate=!0}y.uniforms.tDiffuse.value=b.texture,U.setRenderTarget(P),U.render(g,S),P=null,x=!1},this.isCompositing=function(){return x},this.dispose=function(){c.dispose(),u!==null&&u.dispose(),f!==null&&f.dispose(),m.dispose(),y.dispose()}}var Cd=new Sn,Pd=new Mi(1,1),Id=new vs(1),Dd=new us,Ld=new qa,Fd=new _s,ld=[],cd=[],hd=new Float32Array(16),ud=new Float32Array(9),dd=new Float32Array(4);function $r(i,e,t){let n=i[0];if(n<=0||n>0)return i;let s=e*t,o=ld[s];if(o===void 0&&(o=new Float32Array(s),ld[s]=o),e!==0){n.toArray(o,0);for(let c=1,u=0;c!==e;++c)u+=t,i[c].toArray(o,u)}return o}function Zt(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function Jt(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function il(i,e){let t=cd[e];t===void 0&&(t=new Int32Array(e),cd[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function sS(i,e){let t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function aS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Zt(t,e))return;i.uniform2fv(this.addr,e),Jt(t,e)}}function oS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(Zt(t,e))return;i.uniform3fv(this.addr,e),Jt(t,e)}}function lS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Zt(t,e))return;i.uniform4fv(this.addr,e),Jt(t,e)}}function cS(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Zt(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),Jt(t,e)}else{if(Zt(t,n))return;dd.set(n),i.uniformMatrix2fv(this.addr,!1,dd),Jt(t,n)}}function hS(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Zt(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),Jt(t,e)}else{if(Zt(t,n))return;ud.set(n),i.uniformMatrix3fv(this.addr,!1,ud),Jt(t,n)}}function uS(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Zt(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),Jt(t,e)}else{if(Zt(t,n))return;hd.set(n),i.uniformMatrix4fv(this.addr,!1,hd),Jt(t,n)}}function dS(i,e){let t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function fS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Zt(t,e))return;i.uniform2iv(this.addr,e),Jt(t,e)}}function pS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Zt(t,e))return;i.uniform3iv(this.addr,e),Jt(t,e)}}function mS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Zt(t,e))return;i.uniform4iv(this.addr,e),Jt(t,e)}}function gS(i,e){let t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function _S(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Zt(t,e))return;i.uniform2uiv(this.addr,e),Jt(t,e)}}function vS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Zt(t,e))return;i.uniform3uiv(this.addr,e),Jt(t,e)}}function yS(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Zt(t,e))return;i.uniform4uiv(this.addr,e),Jt(t,e)}}function rl(i){return i.version===0&&(i.compareFunction=wc,i.needsUpdate=!0),i}function xS(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let o;this.type===i.SAMPLER_2D_SHADOW?o=rl(Pd):o=Cd,t.setTexture2D(e||o,s)}function SS(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||Ld,s)}function MS(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let o;this.type===i.SAMPLER_CUBE_SHADOW?o=rl(Id):o=Fd,t.setTextureCube(e||o,s)}function bS(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||Dd,s)}function ES(i){switch(i){case 5126:return sS;case 35664:return aS;case 35665:return oS;case 35666:return lS;case 35674:return cS;case 35675:return hS;case 35676:return uS;case 5124:case 35670:return dS;case 35667:case 35671:return fS;case 35668:case 35672:return pS;case 35669:case 35673:return mS;case 5125:return gS;case 36294:return _S;case 36295:return vS;case 36296:return yS;case 35678:case 36198:case 36298:case 36306:case 35682:return xS;case 35679:case 36299:case 36307:return SS;case 35680:case 36300:case 36308:case 36293:return MS;case 36289:case 36303:case 36311:case 36292:return bS}}function wS(i,e){i.uniform1fv(this.addr,e)}function TS(i,e){let t=$r(e,this.size,2);i.uniform2fv(this.addr,t)}function AS(i,e){let t=$r(e,this.size,3);i.uniform3fv(this.addr,t)}function RS(i,e){let t=$r(e,this.size,4);i.uniform4fv(this.addr,t)}function CS(i,e){let t=$r(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function PS(i,e){let t=$r(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function IS(i,e){let t=$r(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function DS(i,e){i.uniform1iv(this.addr,e)}function LS(i,e){i.uniform2iv(this.addr,e)}function FS(i,e){i.uniform3iv(this.addr,e)}function NS(i,e){i.uniform4iv(this.addr,e)}function US(i,e){i.uniform1uiv(this.addr,e)}function OS(i,e){i.uniform2uiv(this.addr,e)}function BS(i,e){i.uniform3uiv(this.addr,e)}function kS(i,e){i.uniform4uiv(this.addr,e)}function zS(i,e,t){let n=this.cache,s=e.length,o=il(t,s);Zt(n,o)||(i.uniform1iv(this.addr,o),Jt(n,o));let c;this.type===i.SAMPLER_2D_SHADOW?c=rl(Pd):c=Cd;for(let u=0;u!==s;++u)t.setTexture2D(e[u]||c,o[u])}function GS(i,e,t){let n=this.cache,s=e.length,o=il(t,s);Zt(n,o)||(i.uniform1iv(this.addr,o),Jt(n,o));for(let c=0;c!==s;++c)t.setTexture3D(e[c]||Ld,o[c])}function VS(i,e,t){let n=this.cache,s=e.length,o=il(t,s);Zt(n,o)||(i.uniform1iv(this.addr,o),Jt(n,o));let c;this.type===i.SAMPLER_CUBE_SHADOW?c=rl(Id):c=Fd;for(let u=0;u!==s;++u)t.setTextureCube(e[u]||c,o[u])}function HS(i,e,t){let n=this.cache,s=e.length,o=il(t,s);Zt(n,o)||(i.uniform1iv(this.addr,o),Jt(n,o));for(let c=0;c!==s;++c)t.setTexture2DArray(e[c]||Dd,o[c])}function WS(i){switch(i){case 5126:return wS;case 35664:return TS;case 35665:return AS;case 35666:return RS;case 35674:return CS;case 35675:return PS;case 35676:return IS;case 5124:case 35670:return DS;case 35667:case 35671:return LS;case 35668:case 35672:return FS;case 35669:case 35673:return NS;case 5125:return US;case 36294:return OS;case 36295:return BS;case 36296:return kS;case 35678:case 36198:case 36298:case 36306:case 35682:return zS;case 35679:case 36299:case 36307:return GS;case 35680:case 36300:case 36308:case 36293:return VS;case 36289:case 36303:case 36311:case 36292:return HS}}var Bc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=ES(t.type)}},kc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=WS(t.type)}},zc=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let s=this.seq;for(let o=0,c=s.length;o!==c;++o){let u=s[o];u.setValue(e,t[u.id],n)}}},Uc=/(\w+)(\])?(\[|\.)?/g;function fd(i,e){i.seq.push(e),i.map[e.id]=e}function XS(i,e,t){let n=i.name,s=n.length;for(Uc.lastIndex=0;;){let o=Uc.exec(n),c=Uc.lastIndex,u=o[1],f=o[2]==="]",d=o[3];if(f&&(u=u|0),d===void 0||d==="["&&c+2===s){fd(t,d===void 0?new Bc(u,i,e):new kc(u,i,e));break}else{let y=t.map[u];y===void 0&&(y=new zc(u),fd(t,y)),t=y}}}var Xr=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let c=0;c<n;++c){let u=e.getActiveUniform(t,c),f=e.getUniformLocation(t,u.name);XS(u,f,this)}let s=[],o=[];for(let c of this.seq)c.type===e.SAMPLER_2D_SHADOW||c.type===e.SAMPLER_CUBE_SHADOW||c.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(c):o.push(c);s.length>0&&(this.seq=s.concat(o))}setValue(e,t,n,s){let o=this.map[t];o!==void 0&&o.setValue(e,n,s)}setOptional(e,t,n){let s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let o=0,c=t.length;o!==c;++o){let u=t[o],f=n[u.id];f.needsUpdate!==!1&&u.setValue(e,f.value,s)}}static seqWithValue(e,t){let n=[];for(let s=0,o=e.length;s!==o;++s){let c=e[s];c.id in t&&n.push(c)}return n}};function pd(i,e,t){let n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}var $S=37297,qS=0;function YS(i,e){let t=i.split(`
`),n=[],s=Math.max(e-6,0),o=Math.min(e+6,t.length);for(let c=s;c<o;c++){let u=c+1;n.push(`${u===e?">":" "} ${u}: ${t[c]}`)}return n.join(`
`)}var md=new at;function jS(i){yt._getMatrix(md,yt.workingColorSpace,i);let e=`mat3( ${md.elements.map(t=>t.toFixed(4))} )`;switch(yt.getTransfer(i)){case cs:return[e,"LinearTransferOETF"];case Rt:return[e,"sRGBTransferOETF"];default:return Qe("WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function gd(i,e,t){let n=i.getShaderParameter(e,i.COMPILE_STATUS),o=(i.getShaderInfoLog(e)||"").trim();if(n&&o==="")return"";let c=/ERROR: 0:(\d+)/.exec(o);if(c){let u=parseInt(c[1]);return t.toUpperCase()+`

`+o+`

`+YS(i.getShaderSource(e),u)}else return o}function ZS(i,e){let t=jS(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var JS={[lc]:"Linear",[cc]:"Reinhard",[hc]:"Cineon",[uc]:"ACESFilmic",[fc]:"AgX",[pc]:"Neutral",[dc]:"Custom"};function KS(i,e){let t=JS[e];return t===void 0?(Qe("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var el=new j;function QS(){yt.getLuminanceCoefficients(el);let i=el.x.toFixed(4),e=el.y.toFixed(4),t=el.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function eM(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Hs).join(`
`)}function tM(i){let e=[];for(let t in i){let n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function nM(i,e){let t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let o=i.getActiveAttrib(e,s),c=o.name,u=1;o.type===i.FLOAT_MAT2&&(u=2),o.type===i.FLOAT_MAT3&&(u=3),o.type===i.FLOAT_MAT4&&(u=4),t[c]={type:o.type,location:i.getAttribLocation(e,c),locationSize:u}}return t}function Hs(i){return i!==""}function _d(i,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function vd(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var iM=/^[ \t]*#include +<([\w\d./]+)>/gm;function Gc(i){return i.replace(iM,rM)}function rM(i,e){let t=mt[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Gc(t)}var sM=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function yd(i){return i.replace(sM,aM)}function aM(i,e,t,n){let s="";for(let o=parseInt(e);o<parseInt(t);o++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+o+" ]").replace(/UNROLLED_LOOP_INDEX/g,o);return s}function xd(i){let e=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?e+=`
#define HIGH_PRECISION`:i.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var oM={[Fs]:"SHADOWMAP_TYPE_PCF",[zr]:"SHADOWMAP_TYPE_VSM"};function lM(i){return oM[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var cM={[Vr]:"ENVMAP_MODE_REFRACTION"};function hM(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":cM[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var uM={[oc]:"ENVMAP_BLENDING_MULTIPLY",[Uu]:"ENVMAP_BLENDING_MIX",[Ou]:"ENVMAP_BLENDING_ADD"};function dM(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":uM[i.combine]||"ENVMAP_BLENDING_NONE"}function fM(i,e,t,n){let s=i.getContext(),o=t.defines,c=t.vertexShader,u=t.fragmentShader,f=lM(t),d=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",m=hM(t),y=dM(t),g=eM(t),S=tM(o),E=s.createProgram(),C,x,v=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(C=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,S].filter(Hs).join(`
`),C.length>0&&(C+=`
`),x=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,S].filter(Hs).join(`
`),x.length>0&&(x+=`
`)):(C=[xd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,S,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+m:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+f:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Hs).join(`
`),x=[xd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,S,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+d:"",t.envMap?"#define "+m:"",t.envMap?"#define "+y:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+f:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==ci?"#define TONE_MAPPING":"",t.toneMapping!==ci?mt.tonemapping_pars_fragment:"",t.toneMapping!==ci?KS("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",mt.colorspace_pars_fragment,ZS("linearToOutputTexel",t.outputColorSpace),QS(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Hs).join(`
`)),c=Gc(c),c=_d(c,t),c=vd(c,t),u=Gc(u),u=_d(u,t),u=vd(u,t),c=yd(c),u=yd(u),t.isRawShaderMaterial!==!0&&(v=`#version 300 es
`,C=[g,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+C,x=["#define varying in",t.glslVersion===Tc?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Tc?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+x);let P=v+C+c,O=v+x+u,I=pd(s,s.VERTEX_SHADER,P),U=pd(s,s.FRAGMENT_SHADER,O);s.attachShader(E,I),s.attachShader(E,U),t.index0AttributeName!==void 0?s.bindAttribLocation(E,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(E,0,"position"),s.linkProgram(E);function N(k){if(i.debug.checkShaderErrors){let Y=s.getProgramInfoLog(E)||"",J=s.getShaderInfoLog(I)||"",ee=s.getShaderInfoLog(U)||"",z=Y.trim(),ie=J.trim(),G=ee.trim(),ne=!0,Se=!0;if(s.getProgramParameter(E,s.LINK_STATUS)===!1)if(ne=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,E,I,U);else{let re=gd(s,I,"vertex"),H=gd(s,U,"fragment");tt("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(E,s.VALIDATE_STATUS)+`

Material Name: `+k.name+`
Material Type: `+k.type+`

Program Info Log: `+z+`
`+re+`
`+H)}else z!==""?Qe("WebGLProgram: Program Info Log:",z):(ie===""||G==="")&&(Se=!1);Se&&(k.diagnostics={runnable:ne,programLog:z,vertexShader:{log:ie,prefix:C},fragmentShader:{log:G,prefix:x}})}s.deleteShader(I),s.deleteShader(U),b=new Xr(s,E),D=nM(s,E)}let b;this.getUniforms=function(){return b===void 0&&N(this),b};let D;this.getAttributes=function(){return D===void 0&&N(this),D};let q=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return q===!1&&(q=s.getProgramParameter(E,$S)),q},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(E),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=qS++,this.cacheKey=e,this.usedTimes=1,this.program=E,this.vertexShader=I,this.fragmentShader=U,this}var pM=0,Vc=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new Hc(e),t.set(e,n)),n}},Hc=class{constructor(e){this.id=pM++,this.code=e,this.usedTimes=0}};function mM(i){return i===Vi||i===zs||i===Gs}function gM(i,e,t,n,s,o){let c=new Dr,u=new Vc,f=new Set,d=[],m=new Map,y=n.logarithmicDepthBuffer,g={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function S(b){return f.add(b),b===0?"uv":`uv${b}`}function E(b,D,q,k,Y,J){let ee=k.fog,z=Y.geometry,ie=b.isMeshStandardMaterial||b.isMeshLambertMaterial||b.isMeshPhongMaterial?k.environment:null,G=b.isMeshStandardMaterial||b.isMeshLambertMaterial&&!b.envMap||b.isMeshPhongMaterial&&!b.envMap,ne=e.get(b.envMap||ie,G),Se=g[b.type],re=n.precision;b.precision!==null&&(re=n.getMaxPrecision(b.precision),re!==b.precision&&Qe("WebGLProgram.getParameters:",b.precision,"not supported, using",re,"instead."));let H=z.morphAttributes.position||z.morphAttributes.normal||z.morphAttributes.color,me=H!==void 0?H.length:0,We=0;z.morphAttributes.position!==void 0&&(We=1),z.morphAttributes.normal!==void 0&&(We=2),z.morphAttributes.color!==void 0&&(We=3);let nt,ue,Fe,Pe;if(Se){let Oe=ui[Se];nt=Oe.vertexShader,ue=Oe.fragmentShader}else{nt=b.vertexShader,ue=b.fragmentShader;let Oe=u.getVertexShaderStage(b),Et=u.getFragmentShaderStage(b);u.update(b,Oe,Et),Fe=Oe.id,Pe=Et.id}let Ye=i.getRenderTarget(),Ue=i.state.buffers.depth.getReversed(),rt=Y.isInstancedMesh===!0,Gt=Y.isBatchedMesh===!0,Ke=!!b.map,bt=!!b.matcap,Tt=!!ne,dt=Tt&&ne.isPMREMTexture===!0,Vt=!!b.aoMap,ut=!!b.lightMap,Ct=!!b.bumpMap&&b.wireframe===!1,xt=!!b.normalMap,Qt=!!b.displacementMap,De=!!b.emissiveMap,$e=!!b.metalnessMap,an=!!b.roughnessMap,en=b.anisotropy>0,W=b.clearcoat>0,pn=b.diffuseRoughness>0,At=b.dispersion>0,Ft=b.retroreflectivity>0,Le=b.iridescence>0,Wt=b.sheen>0,je=b.transmission>0,Ze=en&&!!b.anisotropyMap,L=W&&!!b.clearcoatMap,T=W&&!!b.clearcoatNormalMap,Z=W&&!!b.clearcoatRoughnessMap,ve=pn&&!!b.diffuseRoughnessMap,de=Le&&!!b.iridescenceMap,pe=Le&&!!b.iridescenceThicknessMap,Me=Wt&&!!b.sheenColorMap,ae=Wt&&!!b.sheenRoughnessMap,le=!!b.specularMap,Re=!!b.specularColorMap,B=!!b.specularIntensityMap,he=je&&!!b.transmissionMap,se=je&&!!b.thicknessMap,Ce=!!b.gradientMap,we=!!b.alphaMap,Ae=b.alphaTest>0,Xe=!!b.alphaHash,ot=!!b.extensions,Ee=ci;b.toneMapped&&(Ye===null||Ye.isXRRenderTarget===!0)&&(Ee=i.toneMapping);let qe=dt?ne.isCompressedCubeTexture?ne.image[0].mipmaps:ne.mipmaps:null,lt={shaderID:Se,shaderType:b.type,shaderName:b.name,vertexShader:nt,fragmentShader:ue,defines:b.defines,customVertexShaderID:Fe,customFragmentShaderID:Pe,isRawShaderMaterial:b.isRawShaderMaterial===!0,glslVersion:b.glslVersion,precision:re,batching:Gt,batchingColor:Gt&&Y._colorsTexture!==null,instancing:rt,instancingColor:rt&&Y.instanceColor!==null,instancingMorph:rt&&Y.morphTexture!==null,outputColorSpace:Ye===null?i.outputColorSpace:Ye.isXRRenderTarget===!0?Ye.texture.colorSpace:yt.workingColorSpace,alphaToCoverage:!!b.alphaToCoverage,map:Ke,matcap:bt,envMap:Tt,envMapMode:Tt&&ne.mapping,envMapPMREM:dt,envMapMaxLod:dt?qe.length-1:null,envMapSize:dt?qe[0].width:null,aoMap:Vt,lightMap:ut,bumpMap:Ct,normalMap:xt,displacementMap:Qt,emissiveMap:De,normalMapObjectSpace:xt&&b.normalMapType===zu,normalMapTangentSpace:xt&&b.normalMapType===Ko,packedNormalMap:xt&&b.normalMapType===Ko&&mM(b.normalMap.format),metalnessMap:$e,roughnessMap:an,anisotropy:en,anisotropyMap:Ze,clearcoat:W,clearcoatMap:L,clearcoatNormalMap:T,clearcoatRoughnessMap:Z,diffuseRoughness:pn,diffuseRoughnessMap:ve,dispersion:At,retroreflection:Ft,iridescence:Le,iridescenceMap:de,iridescenceThicknessMap:pe,sheen:Wt,sheenColorMap:Me,sheenRoughnessMap:ae,specularMap:le,specularColorMap:Re,specularIntensityMap:B,transmission:je,transmissionMap:he,thicknessMap:se,gradientMap:Ce,opaque:b.transparent===!1&&b.blending===Gr&&b.alphaToCoverage===!1,alphaMap:we,alphaTest:Ae,alphaHash:Xe,combine:b.combine,mapUv:Ke&&S(b.map.channel),aoMapUv:Vt&&S(b.aoMap.channel),lightMapUv:ut&&S(b.lightMap.channel),bumpMapUv:Ct&&S(b.bumpMap.channel),normalMapUv:xt&&S(b.normalMap.channel),displacementMapUv:Qt&&S(b.displacementMap.channel),emissiveMapUv:De&&S(b.emissiveMap.channel),metalnessMapUv:$e&&S(b.metalnessMap.channel),roughnessMapUv:an&&S(b.roughnessMap.channel),anisotropyMapUv:Ze&&S(b.anisotropyMap.channel),clearcoatMapUv:L&&S(b.clearcoatMap.channel),clearcoatNormalMapUv:T&&S(b.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:Z&&S(b.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ve&&S(b.diffuseRoughnessMap.channel),iridescenceMapUv:de&&S(b.iridescenceMap.channel),iridescenceThicknessMapUv:pe&&S(b.iridescenceThicknessMap.channel),sheenColorMapUv:Me&&S(b.sheenColorMap.channel),sheenRoughnessMapUv:ae&&S(b.sheenRoughnessMap.channel),specularMapUv:le&&S(b.specularMap.channel),specularColorMapUv:Re&&S(b.specularColorMap.channel),specularIntensityMapUv:B&&S(b.specularIntensityMap.channel),transmissionMapUv:he&&S(b.transmissionMap.channel),thicknessMapUv:se&&S(b.thicknessMap.channel),alphaMapUv:we&&S(b.alphaMap.channel),vertexTangents:!!z.attributes.tangent&&(xt||en),vertexNormals:!!z.attributes.normal,vertexColors:b.vertexColors,vertexAlphas:b.vertexColors===!0&&!!z.attributes.color&&z.attributes.color.itemSize===4,pointsUvs:Y.isPoints===!0&&!!z.attributes.uv&&(Ke||we),fog:!!ee,useFog:b.fog===!0,fogExp2:!!ee&&ee.isFogExp2,flatShading:b.wireframe===!1&&(b.flatShading===!0||z.attributes.normal===void 0&&xt===!1&&(b.isMeshLambertMaterial||b.isMeshPhongMaterial||b.isMeshStandardMaterial||b.isMeshPhysicalMaterial)),sizeAttenuation:b.sizeAttenuation===!0,logarithmicDepthBuffer:y,reversedDepthBuffer:Ue,skinning:Y.isSkinnedMesh===!0,hasPositionAttribute:z.attributes.position!==void 0,morphTargets:z.morphAttributes.position!==void 0,morphNormals:z.morphAttributes.normal!==void 0,morphColors:z.morphAttributes.color!==void 0,morphTargetsCount:me,morphTextureStride:We,numSunLights:D.sun.length,numDirLights:D.directional.length,numPointLights:D.point.length,numSpotLights:D.spot.length,numSpotLightMaps:D.spotLightMap.length,numRectAreaLights:D.rectArea.length,numHemiLights:D.hemi.length,numSunLightShadows:D.sunShadowMap.length,numDirLightShadows:D.directionalShadowMap.length,numPointLightShadows:D.pointShadowMap.length,numSpotLightShadows:D.spotShadowMap.length,numSpotLightShadowsWithMaps:D.numSpotLightShadowsWithMaps,numLightProbes:D.numLightProbes,numLightProbeGrids:J.filter(Oe=>Oe.texture!==null).length,numClippingPlanes:o.numPlanes,numClipIntersection:o.numIntersection,dithering:b.dithering,shadowMapEnabled:i.shadowMap.enabled&&q.length>0,shadowMapType:i.shadowMap.type,toneMapping:Ee,decodeVideoTexture:Ke&&b.map.isVideoTexture===!0&&yt.getTransfer(b.map.colorSpace)===Rt,decodeVideoTextureEmissive:De&&b.emissiveMap.isVideoTexture===!0&&yt.getTransfer(b.emissiveMap.colorSpace)===Rt,premultipliedAlpha:b.premultipliedAlpha,doubleSided:b.side===li,flipSided:b.side===xn,useDepthPacking:b.depthPacking>=0,depthPacking:b.depthPacking||0,index0AttributeName:b.index0AttributeName,extensionClipCullDistance:ot&&b.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(ot&&b.extensions.multiDraw===!0||Gt)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:b.customProgramCacheKey()};return lt.vertexUv1s=f.has(1),lt.vertexUv2s=f.has(2),lt.vertexUv3s=f.has(3),f.clear(),lt}function C(b){let D=[];if(b.shaderID?D.push(b.shaderID):(D.push(b.customVertexShaderID),D.push(b.customFragmentShaderID)),b.defines!==void 0)for(let q in b.defines)D.push(q),D.push(b.defines[q]);return b.isRawShaderMaterial===!1&&(x(D,b),v(D,b),D.push(i.outputColorSpace)),D.push(b.customProgramCacheKey),D.join()}function x(b,D){b.push(D.precision),b.push(D.outputColorSpace),b.push(D.envMapMode),b.push(D.envMapPMREM),b.push(D.envMapMaxLod),b.push(D.envMapSize),b.push(D.mapUv),b.push(D.alphaMapUv),b.push(D.lightMapUv),b.push(D.aoMapUv),b.push(D.bumpMapUv),b.push(D.normalMapUv),b.push(D.displacementMapUv),b.push(D.emissiveMapUv),b.push(D.metalnessMapUv),b.push(D.roughnessMapUv),b.push(D.anisotropyMapUv),b.push(D.clearcoatMapUv),b.push(D.clearcoatNormalMapUv),b.push(D.clearcoatRoughnessMapUv),b.push(D.diffuseRoughnessMapUv),b.push(D.iridescenceMapUv),b.push(D.iridescenceThicknessMapUv),b.push(D.sheenColorMapUv),b.push(D.sheenRoughnessMapUv),b.push(D.specularMapUv),b.push(D.specularColorMapUv),b.push(D.specularIntensityMapUv),b.push(D.transmissionMapUv),b.push(D.thicknessMapUv),b.push(D.combine),b.push(D.fogExp2),b.push(D.sizeAttenuation),b.push(D.morphTargetsCount),b.push(D.numSunLights),b.push(D.numDirLights),b.push(D.numPointLights),b.push(D.numSpotLights),b.push(D.numSpotLightMaps),b.push(D.numHemiLights),b.push(D.numRectAreaLights),b.push(D.numSunLightShadows),b.push(D.numDirLightShadows),b.push(D.numPointLightShadows),b.push(D.numSpotLightShadows),b.push(D.numSpotLightShadowsWithMaps),b.push(D.numLightProbes),b.push(D.numLightProbeGrids),b.push(D.shadowMapType),b.push(D.toneMapping),b.push(D.numClippingPlanes),b.push(D.numClipIntersection),b.push(D.depthPacking)}function v(b,D){c.disableAll(),D.instancing&&c.enable(0),D.instancingColor&&c.enable(1),D.instancingMorph&&c.enable(2),D.matcap&&c.enable(3),D.envMap&&c.enable(4),D.normalMapObjectSpace&&c.enable(5),D.normalMapTangentSpace&&c.enable(6),D.clearcoat&&c.enable(7),D.iridescence&&c.enable(8),D.alphaTest&&c.enable(9),D.vertexColors&&c.enable(10),D.vertexAlphas&&c.enable(11),D.vertexUv1s&&c.enable(12),D.vertexUv2s&&c.enable(13),D.vertexUv3s&&c.enable(14),D.vertexTangents&&c.enable(15),D.anisotropy&&c.enable(16),D.alphaHash&&c.enable(17),D.batching&&c.enable(18),D.dispersion&&c.enable(19),D.retroreflection&&c.enable(24),D.diffuseRoughness&&c.enable(25),D.batchingColor&&c.enable(20),D.gradientMap&&c.enable(21),D.packedNormalMap&&c.enable(22),D.vertexNormals&&c.enable(23),b.push(c.mask),c.disableAll(),D.fog&&c.enable(0),D.useFog&&c.enable(1),D.flatShading&&c.enable(2),D.logarithmicDepthBuffer&&c.enable(3),D.reversedDepthBuffer&&c.enable(4),D.skinning&&c.enable(5),D.morphTargets&&c.enable(6),D.morphNormals&&c.enable(7),D.morphColors&&c.enable(8),D.premultipliedAlpha&&c.enable(9),D.shadowMapEnabled&&c.enable(10),D.doubleSided&&c.enable(11),D.flipSided&&c.enable(12),D.useDepthPacking&&c.enable(13),D.dithering&&c.enable(14),D.transmission&&c.enable(15),D.sheen&&c.enable(16),D.opaque&&c.enable(17),D.pointsUvs&&c.enable(18),D.decodeVideoTexture&&c.enable(19),D.decodeVideoTextureEmissive&&c.enable(20),D.alphaToCoverage&&c.enable(21),D.numLightProbeGrids>0&&c.enable(22),D.hasPositionAttribute&&c.enable(23),b.push(c.mask)}function P(b){let D=g[b.type],q;if(D){let k=ui[D];q=td.clone(k.uniforms)}else q=b.uniforms;return q}function O(b,D){let q=m.get(D);return q!==void 0?++q.usedTimes:(q=new fM(i,D,b,s),d.push(q),m.set(D,q)),q}function I(b){if(--b.usedTimes===0){let D=d.indexOf(b);d[D]=d[d.length-1],d.pop(),m.delete(b.cacheKey),b.destroy()}}function U(b){u.remove(b)}function N(){u.dispose()}return{getParameters:E,getProgramCacheKey:C,getUniforms:P,acquireProgram:O,releaseProgram:I,releaseShaderCache:U,programs:d,dispose:N}}function _M(){let i=new WeakMap;function e(c){return i.has(c)}function t(c){let u=i.get(c);return u===void 0&&(u={},i.set(c,u)),u}function n(c){i.delete(c)}function s(c,u,f){i.get(c)[u]=f}function o(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:o}}function vM(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.materialVariant!==e.materialVariant?i.materialVariant-e.materialVariant:i.z!==e.z?i.z-e.z:i.id-e.id}function Sd(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function Md(){let i=[],e=0,t=[],n=[],s=[];function o(){e=0,t.length=0,n.length=0,s.length=0}function c(g){let S=0;return g.isInstancedMesh&&(S+=2),g.isSkinnedMesh&&(S+=1),S}function u(g,S,E,C,x,v){let P=i[e];return P===void 0?(P={id:g.id,object:g,geometry:S,material:E,materialVariant:c(g),groupOrder:C,renderOrder:g.renderOrder,z:x,group:v},i[e]=P):(P.id=g.id,P.object=g,P.geometry=S,P.material=E,P.materialVariant=c(g),P.groupOrder=C,P.renderOrder=g.renderOrder,P.z=x,P.group=v),e++,P}function f(g,S,E,C,x,v,P){P.reversedDepth===!0&&(x=-x);let O=u(g,S,E,C,x,v);E.transmission>0?n.push(O):E.transparent===!0?s.push(O):t.push(O)}function d(g,S,E,C,x,v){let P=u(g,S,E,C,x,v);E.transmission>0?n.unshift(P):E.transparent===!0?s.unshift(P):t.unshift(P)}function m(g,S){t.length>1&&t.sort(g||vM),n.length>1&&n.sort(S||Sd),s.length>1&&s.sort(S||Sd)}function y(){for(let g=e,S=i.length;g<S;g++){let E=i[g];if(E.id===null)break;E.id=null,E.object=null,E.geometry=null,E.material=null,E.group=null}}return{opaque:t,transmissive:n,transparent:s,init:o,push:f,unshift:d,finish:y,sort:m}}function yM(){let i=new WeakMap;function e(n,s){let o=i.get(n),c;return o===void 0?(c=new Md,i.set(n,[c])):s>=o.length?(c=new Md,o.push(c)):c=o[s],c}function t(){i=new WeakMap}return{get:e,dispose:t}}function xM(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new j,color:new ct};break;case"SpotLight":t={position:new j,direction:new j,color:new ct,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new j,color:new ct,distance:0,decay:0};break;case"HemisphereLight":t={direction:new j,skyColor:new ct,groundColor:new ct};break;case"RectAreaLight":t={color:new ct,position:new j,halfWidth:new j,halfHeight:new j};break}return i[e.id]=t,t}}}function SM(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new et};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new et};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new et,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}var MM=0;function bM(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function EM(i){let e=new xM,t=SM(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let d=0;d<9;d++)n.probe.push(new j);let s=new j,o=new Lt,c=new Lt;function u(d){let m=0,y=0,g=0;for(let J=0;J<9;J++)n.probe[J].set(0,0,0);let S=0,E=0,C=0,x=0,v=0,P=0,O=0,I=0,U=0,N=0,b=0,D=0,q=0,k=0;d.sort(bM);for(let J=0,ee=d.length;J<ee;J++){let z=d[J],ie=z.color,G=z.intensity,ne=z.distance,Se=null;if(z.shadow&&z.shadow.map&&(z.shadow.map.texture.format===Vi?Se=z.shadow.map.texture:Se=z.shadow.map.depthTexture||z.shadow.map.texture),z.isAmbientLight)m+=ie.r*G,y+=ie.g*G,g+=ie.b*G;else if(z.isLightProbe){for(let re=0;re<9;re++)n.probe[re].addScaledVector(z.sh.coefficients[re],G);k++}else if(z.isSunLight){let re=e.get(z);if(re.color.copy(z.color).multiplyScalar(z.intensity),z.castShadow){let H=z.shadow,me=t.get(z);me.shadowIntensity=H.intensity,me.shadowBias=H.bias,me.shadowNormalBias=H.normalBias,me.shadowRadius=H.radius,me.shadowMapSize.copy(H.mapSize).multiply(H.getFrameExtents()),n.sunShadow[E]=me,n.sunShadowMap[E]=Se;let We=H.getViewportCount();for(let nt=0;nt<We;nt++)n.sunShadowMatrix[C+nt]=H.getMatrix(nt),n.sunShadowCascade[C+nt]=H._cascadeData[nt];C+=We,E++}n.sun[S]=re,S++}else if(z.isDirectionalLight){let re=e.get(z);if(re.color.copy(z.color).multiplyScalar(z.intensity),z.castShadow){let H=z.shadow,me=t.get(z);me.shadowIntensity=H.intensity,me.shadowBias=H.bias,me.shadowNormalBias=H.normalBias,me.shadowRadius=H.radius,me.shadowMapSize=H.mapSize,n.directionalShadow[x]=me,n.directionalShadowMap[x]=Se,n.directionalShadowMatrix[x]=z.shadow.matrix,U++}n.directional[x]=re,x++}else if(z.isSpotLight){let re=e.get(z);re.position.setFromMatrixPosition(z.matrixWorld),re.color.copy(ie).multiplyScalar(G),re.distance=ne,re.coneCos=Math.cos(z.angle),re.penumbraCos=Math.cos(z.angle*(1-z.penumbra)),re.decay=z.decay,n.spot[P]=re;let H=z.shadow;if(z.map&&(n.spotLightMap[D]=z.map,D++,H.updateMatrices(z),z.castShadow&&q++),n.spotLightMatrix[P]=H.matrix,z.castShadow){let me=t.get(z);me.shadowIntensity=H.intensity,me.shadowBias=H.bias,me.shadowNormalBias=H.normalBias,me.shadowRadius=H.radius,me.shadowMapSize=H.mapSize,n.spotShadow[P]=me,n.spotShadowMap[P]=Se,b++}P++}else if(z.isRectAreaLight){let re=e.get(z);re.color.copy(ie).multiplyScalar(G),re.halfWidth.set(z.width*.5,0,0),re.halfHeight.set(0,z.height*.5,0),n.rectArea[O]=re,O++}else if(z.isPointLight){let re=e.get(z);if(re.color.copy(z.color).multiplyScalar(z.intensity),re.distance=z.distance,re.decay=z.decay,z.castShadow){let H=z.shadow,me=t.get(z);me.shadowIntensity=H.intensity,me.shadowBias=H.bias,me.shadowNormalBias=H.normalBias,me.shadowRadius=H.radius,me.shadowMapSize=H.mapSize,me.shadowCameraNear=H.camera.near,me.shadowCameraFar=H.camera.far,n.pointShadow[v]=me,n.pointShadowMap[v]=Se,n.pointShadowMatrix[v]=z.shadow.matrix,N++}n.point[v]=re,v++}else if(z.isHemisphereLight){let re=e.get(z);re.skyColor.copy(z.color).multiplyScalar(G),re.groundColor.copy(z.groundColor).multiplyScalar(G),n.hemi[I]=re,I++}}O>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=Be.LTC_FLOAT_1,n.rectAreaLTC2=Be.LTC_FLOAT_2):(n.rectAreaLTC1=Be.LTC_HALF_1,n.rectAreaLTC2=Be.LTC_HALF_2)),n.ambient[0]=m,n.ambient[1]=y,n.ambient[2]=g;let Y=n.hash;(Y.sunLength!==S||Y.directionalLength!==x||Y.pointLength!==v||Y.spotLength!==P||Y.rectAreaLength!==O||Y.hemiLength!==I||Y.numSunShadows!==E||Y.numDirectionalShadows!==U||Y.numPointShadows!==N||Y.numSpotShadows!==b||Y.numSpotMaps!==D||Y.numLightProbes!==k)&&(n.sun.length=S,n.directional.length=x,n.spot.length=P,n.rectArea.length=O,n.point.length=v,n.hemi.length=I,n.sunShadow.length=E,n.sunShadowMap.length=E,n.sunShadowMatrix.length=C,n.sunShadowCascade.length=C,n.directionalShadow.length=U,n.directionalShadowMap.length=U,n.directionalShadowMatrix.length=U,n.pointShadow.length=N,n.pointShadowMap.length=N,n.pointShadowMatrix.length=N,n.spotShadow.length=b,n.spotShadowMap.length=b,n.spotLightMatrix.length=b+D-q,n.spotLightMap.length=D,n.numSpotLightShadowsWithMaps=q,n.numLightProbes=k,Y.sunLength=S,Y.directionalLength=x,Y.pointLength=v,Y.spotLength=P,Y.rectAreaLength=O,Y.hemiLength=I,Y.numSunShadows=E,Y.numDirectionalShadows=U,Y.numPointShadows=N,Y.numSpotShadows=b,Y.numSpotMaps=D,Y.numLightProbes=k,n.version=MM++)}function f(d,m){let y=0,g=0,S=0,E=0,C=0,x=0,v=m.matrixWorldInverse;for(let P=0,O=d.length;P<O;P++){let I=d[P];if(I.isSunLight){let U=n.sun[y];U.direction.setFromMatrixPosition(I.matrixWorld),U.direction.transformDirection(v),y++}else if(I.isDirectionalLight){let U=n.directional[g];U.direction.setFromMatrixPosition(I.matrixWorld),s.setFromMatrixPosition(I.target.matrixWorld),U.direction.sub(s),U.direction.transformDirection(v),g++}else if(I.isSpotLight){let U=n.spot[E];U.position.setFromMatrixPosition(I.matrixWorld),U.position.applyMatrix4(v),U.direction.setFromMatrixPosition(I.matrixWorld),s.setFromMatrixPosition(I.target.matrixWorld),U.direction.sub(s),U.direction.transformDirection(v),E++}else if(I.isRectAreaLight){let U=n.rectArea[C];U.position.setFromMatrixPosition(I.matrixWorld),U.position.applyMatrix4(v),c.identity(),o.copy(I.matrixWorld),o.premultiply(v),c.extractRotation(o),U.halfWidth.set(I.width*.5,0,0),U.halfHeight.set(0,I.height*.5,0),U.halfWidth.applyMatrix4(c),U.halfHeight.applyMatrix4(c),C++}else if(I.isPointLight){let U=n.point[S];U.position.setFromMatrixPosition(I.matrixWorld),U.position.applyMatrix4(v),S++}else if(I.isHemisphereLight){let U=n.hemi[x];U.direction.setFromMatrixPosition(I.matrixWorld),U.direction.transformDirection(v),x++}}}return{setup:u,setupView:f,state:n}}function bd(i){let e=new EM(i),t=[],n=[],s=[];function o(y){m.camera=y,t.length=0,n.length=0,s.length=0}function c(y){y.isLightProbeGrid?s.push(y):t.push(y)}function u(y){n.push(y)}function f(){e.setup(t),s.sort((y,g)=>y.priority-g.priority||y.id-g.id)}function d(y){e.setupView(t,y)}let m={lightsArray:t,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:o,state:m,setupLights:f,setupLightsView:d,pushLight:c,pushShadow:u}}function wM(i){let e=new WeakMap;function t(s,o=0){let c=e.get(s),u;return c===void 0?(u=new bd(i),e.set(s,[u])):o>=c.length?(u=new bd(i),c.push(u)):u=c[o],u}function n(){e=new WeakMap}return{get:t,dispose:n}}var TM=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,AM=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,RM=[new j(1,0,0),new j(-1,0,0),new j(0,1,0),new j(0,-1,0),new j(0,0,1),new j(0,0,-1)],CM=[new j(0,-1,0),new j(0,-1,0),new j(0,0,1),new j(0,0,-1),new j(0,-1,0),new j(0,-1,0)],Ed=new Lt,Vs=new j,Oc=new j;function PM(i,e,t){let n=new Fi,s=new et,o=new et,c=new zt,u=new Ka,f=new Qa,d={},m=t.maxTextureSize,y={[Gi]:xn,[xn]:Gi,[li]:li},g=new oi({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new et},radius:{value:4}},vertexShader:TM,fragmentShader:AM}),S=g.clone();S.defines.HORIZONTAL_PASS=1;let E=new yn;E.setAttribute("position",new si(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let C=new Mn(E,g),x=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=Fs;let v=this.type;this.render=function(N,b,D){if(x.enabled===!1||x.autoUpdate===!1&&x.needsUpdate===!1||N.length===0)return;this.type===_u&&(Qe("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=Fs);let q=i.getRenderTarget(),k=i.getActiveCubeFace(),Y=i.getActiveMipmapLevel(),J=i.state;J.setBlending(ir),J.buffers.depth.getReversed()===!0?J.buffers.color.setClear(0,0,0,0):J.buffers.color.setClear(1,1,1,1),J.buffers.depth.setTest(!0),J.setScissorTest(!1);let ee=v!==this.type;ee&&b.traverse(function(z){z.material&&(Array.isArray(z.material)?z.material.forEach(ie=>ie.needsUpdate=!0):z.material.needsUpdate=!0)});for(let z=0,ie=N.length;z<ie;z++){let G=N[z],ne=G.shadow;if(ne===void 0){Qe("WebGLShadowMap:",G,"has no shadow.");continue}if(ne.autoUpdate===!1&&ne.needsUpdate===!1)continue;s.copy(ne.mapSize);let Se=ne.getFrameExtents();s.multiply(Se),o.copy(ne.mapSize),(s.x>m||s.y>m)&&(s.x>m&&(o.x=Math.floor(m/Se.x),s.x=o.x*Se.x,ne.mapSize.x=o.x),s.y>m&&(o.y=Math.floor(m/Se.y),s.y=o.y*Se.y,ne.mapSize.y=o.y));let re=i.state.buffers.depth.getReversed();if(ne.camera._reversedDepth=re,ne.map===null||ee===!0){if(ne.map!==null&&(ne.map.depthTexture!==null&&(ne.map.depthTexture.dispose(),ne.map.depthTexture=null),ne.map.dispose()),this.type===zr){if(G.isPointLight){Qe("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}ne.map=new Cn(s.x,s.y,{format:Vi,type:$n,minFilter:vn,magFilter:vn,generateMipmaps:!1}),ne.map.texture.name=G.name+".shadowMap",ne.map.depthTexture=new Mi(s.x,s.y,Xn),ne.map.depthTexture.name=G.name+".shadowMapDepth",ne.map.depthTexture.format=xi,ne.map.depthTexture.compareFunction=null,ne.map.depthTexture.minFilter=sn,ne.map.depthTexture.magFilter=sn}else G.isPointLight?(ne.map=new Ws(s.x),ne.map.depthTexture=new vs(s.x,Wn)):(ne.map=new Cn(s.x,s.y),ne.map.depthTexture=new Mi(s.x,s.y,Wn)),ne.map.depthTexture.name=G.name+".shadowMap",ne.map.depthTexture.format=xi,this.type===Fs?(ne.map.depthTexture.compareFunction=re?Ec:bc,ne.map.depthTexture.minFilter=vn,ne.map.depthTexture.magFilter=vn):(ne.map.depthTexture.compareFunction=null,ne.map.depthTexture.minFilter=sn,ne.map.depthTexture.magFilter=sn);ne.camera.updateProjectionMatrix()}ne.map.isWebGLCubeRenderTarget!==!0&&(ne.map.width!==s.x||ne.map.height!==s.y)&&ne.map.setSize(s.x,s.y);let H=ne.map.isWebGLCubeRenderTarget?6:ne.getViewportCount();G.isPointLight!==!0&&ne.updateMatrices(G,D);let me=(ne.camera.layers.mask&4294967294)!==0?ne.camera.layers:D.layers;for(let We=0;We<H;We++){let nt=ne.getCamera(We);if(G.isPointLight){let ue=ne.camera,Fe=ne.matrix,Pe=G.distance||ue.far;Pe!==ue.far&&(ue.far=Pe,ue.updateProjectionMatrix()),Vs.setFromMatrixPosition(G.matrixWorld),ue.position.copy(Vs),Oc.copy(ue.position),Oc.add(RM[We]),ue.up.copy(CM[We]),ue.lookAt(Oc),ue.updateMatrixWorld(),Fe.makeTranslation(-Vs.x,-Vs.y,-Vs.z),Ed.multiplyMatrices(ue.projectionMatrix,ue.matrixWorldInverse),ne._frustum.setFromProjectionMatrix(Ed,ue.coordinateSystem,ue.reversedDepth)}if(ne.map.isWebGLCubeRenderTarget)i.setRenderTarget(ne.map,We),i.clear();else{We===0&&(i.setRenderTarget(ne.map),i.clear());let ue=ne.getViewport(We);c.set(o.x*ue.x,o.y*ue.y,o.x*ue.z,o.y*ue.w),J.viewport(c)}n=ne.getFrustum(We),I(b,D,nt,G,me,this.type)}ne.isPointLightShadow!==!0&&this.type===zr&&P(ne,D),ne.needsUpdate=!1}v=this.type,x.needsUpdate=!1,i.setRenderTarget(q,k,Y)};function P(N,b){let D=e.update(C);g.defines.VSM_SAMPLES!==N.blurSamples&&(g.defines.VSM_SAMPLES=N.blurSamples,S.defines.VSM_SAMPLES=N.blurSamples,g.needsUpdate=!0,S.needsUpdate=!0),N.mapPass===null?N.mapPass=new Cn(s.x,s.y,{format:Vi,type:$n}):(N.mapPass.width!==N.map.width||N.mapPass.height!==N.map.height)&&N.mapPass.setSize(N.map.width,N.map.height),g.uniforms.shadow_pass.value=N.map.depthTexture,g.uniforms.resolution.value.set(N.map.width,N.map.height),g.uniforms.radius.value=N.radius,i.setRenderTarget(N.mapPass),i.clear(),i.renderBufferDirect(b,null,D,g,C,null),S.uniforms.shadow_pass.value=N.mapPass.texture,S.uniforms.resolution.value.set(N.map.width,N.map.height),S.uniforms.radius.value=N.radius,i.setRenderTarget(N.map),i.clear(),i.renderBufferDirect(b,null,D,S,C,null)}function O(N,b,D,q){let k=null,Y=D.isPointLight===!0?N.customDistanceMaterial:N.customDepthMaterial;if(Y!==void 0)k=Y;else if(k=D.isPointLight===!0?f:u,i.localClippingEnabled&&b.clipShadows===!0&&Array.isArray(b.clippingPlanes)&&b.clippingPlanes.length!==0||b.displacementMap&&b.displacementScale!==0||b.alphaMap&&b.alphaTest>0||b.map&&b.alphaTest>0||b.alphaToCoverage===!0){let J=k.uuid,ee=b.uuid,z=d[J];z===void 0&&(z={},d[J]=z);let ie=z[ee];ie===void 0&&(ie=k.clone(),z[ee]=ie,b.addEventListener("dispose",U)),k=ie}if(k.visible=b.visible,k.wireframe=b.wireframe,q===zr?k.side=b.shadowSide!==null?b.shadowSide:b.side:k.side=b.shadowSide!==null?b.shadowSide:y[b.side],k.alphaMap=b.alphaMap,k.alphaTest=b.alphaToCoverage===!0?.5:b.alphaTest,k.map=b.map,k.clipShadows=b.clipShadows,k.clippingPlanes=b.clippingPlanes,k.clipIntersection=b.clipIntersection,k.displacementMap=b.displacementMap,k.displacementScale=b.displacementScale,k.displacementBias=b.displacementBias,k.wireframeLinewidth=b.wireframeLinewidth,k.linewidth=b.linewidth,D.isPointLight===!0&&k.isMeshDistanceMaterial===!0){let J=i.properties.get(k);J.light=D}return k}function I(N,b,D,q,k,Y){if(N.visible===!1)return;if(N.layers.test(k)&&(N.isMesh||N.isLine||N.isPoints)&&(N.castShadow||N.receiveShadow&&Y===zr)&&(!N.frustumCulled||N.intersectsFrustum(n))){N.modelViewMatrix.multiplyMatrices(D.matrixWorldInverse,N.matrixWorld);let z=e.update(N),ie=N.material;if(Array.isArray(ie)){let G=z.groups;for(let ne=0,Se=G.length;ne<Se;ne++){let re=G[ne],H=ie[re.materialIndex];if(H&&H.visible){let me=O(N,H,q,Y);N.onBeforeShadow(i,N,b,D,z,me,re),i.renderBufferDirect(D,null,z,me,N,re),N.onAfterShadow(i,N,b,D,z,me,re)}}}else if(ie.visible){let G=O(N,ie,q,Y);N.onBeforeShadow(i,N,b,D,z,G,null),i.renderBufferDirect(D,null,z,G,N,null),N.onAfterShadow(i,N,b,D,z,G,null)}}let ee=N.children;for(let z=0,ie=ee.length;z<ie;z++)I(ee[z],b,D,q,k,Y)}function U(N){N.target.removeEventListener("dispose",U);for(let D in d){let q=d[D],k=N.target.uuid;k in q&&(q[k].dispose(),delete q[k])}}}function IM(i,e){function t(){let B=!1,he=new zt,se=null,Ce=new zt(0,0,0,0);return{setMask:function(we){se!==we&&!B&&(i.colorMask(we,we,we,we),se=we)},setLocked:function(we){B=we},setClear:function(we,Ae,Xe,ot,Ee){Ee===!0&&(we*=ot,Ae*=ot,Xe*=ot),he.set(we,Ae,Xe,ot),Ce.equals(he)===!1&&(i.clearColor(we,Ae,Xe,ot),Ce.copy(he))},reset:function(){B=!1,se=null,Ce.set(-1,0,0,0)}}}function n(){let B=!1,he=!1,se=null,Ce=null,we=null;return{setReversed:function(Ae){if(he!==Ae){let Xe=e.get("EXT_clip_control");Ae?Xe.clipControlEXT(Xe.LOWER_LEFT_EXT,Xe.ZERO_TO_ONE_EXT):Xe.clipControlEXT(Xe.LOWER_LEFT_EXT,Xe.NEGATIVE_ONE_TO_ONE_EXT),he=Ae;let ot=we;we=null,this.setClear(ot)}},getReversed:function(){return he},setTest:function(Ae){Ae?Ue(i.DEPTH_TEST):rt(i.DEPTH_TEST)},setMask:function(Ae){se!==Ae&&!B&&(i.depthMask(Ae),se=Ae)},setFunc:function(Ae){if(he&&(Ae=Ju[Ae]),Ce!==Ae){switch(Ae){case Ua:i.depthFunc(i.NEVER);break;case Oa:i.depthFunc(i.ALWAYS);break;case Ba:i.depthFunc(i.LESS);break;case Tr:i.depthFunc(i.LEQUAL);break;case ka:i.depthFunc(i.EQUAL);break;case za:i.depthFunc(i.GEQUAL);break;case Ga:i.depthFunc(i.GREATER);break;case Va:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}Ce=Ae}},setLocked:function(Ae){B=Ae},setClear:function(Ae){we!==Ae&&(we=Ae,he&&(Ae=1-Ae),i.clearDepth(Ae))},reset:function(){B=!1,se=null,Ce=null,we=null,he=!1}}}function s(){let B=!1,he=null,se=null,Ce=null,we=null,Ae=null,Xe=null,ot=null,Ee=null;return{setTest:function(qe){B||(qe?Ue(i.STENCIL_TEST):rt(i.STENCIL_TEST))},setMask:function(qe){he!==qe&&!B&&(i.stencilMask(qe),he=qe)},setFunc:function(qe,lt,Oe){(se!==qe||Ce!==lt||we!==Oe)&&(i.stencilFunc(qe,lt,Oe),se=qe,Ce=lt,we=Oe)},setOp:function(qe,lt,Oe){(Ae!==qe||Xe!==lt||ot!==Oe)&&(i.stencilOp(qe,lt,Oe),Ae=qe,Xe=lt,ot=Oe)},setLocked:function(qe){B=qe},setClear:function(qe){Ee!==qe&&(i.clearStencil(qe),Ee=qe)},reset:function(){B=!1,he=null,se=null,Ce=null,we=null,Ae=null,Xe=null,ot=null,Ee=null}}}let o=new t,c=new n,u=new s,f={},d=new WeakMap,m={},y={},g={},S=new WeakMap,E=[],C=null,x=!1,v=null,P=null,O=null,I=null,U=null,N=null,b=null,D=new ct(0,0,0),q=0,k=!1,Y=null,J=null,ee=null,z=null,ie=null,G=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),ne=!1,Se=0,re=i.getParameter(i.VERSION);re.indexOf("WebGL")!==-1?(Se=parseFloat(/^WebGL (\d)/.exec(re)[1]),ne=Se>=1):re.indexOf("OpenGL ES")!==-1&&(Se=parseFloat(/^OpenGL ES (\d)/.exec(re)[1]),ne=Se>=2);let H=null,me={},We=i.getParameter(i.SCISSOR_BOX),nt=i.getParameter(i.VIEWPORT),ue=new zt().fromArray(We),Fe=new zt().fromArray(nt);function Pe(B,he,se,Ce){let we=new Uint8Array(4),Ae=i.createTexture();i.bindTexture(B,Ae),i.texParameteri(B,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(B,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let Xe=0;Xe<se;Xe++)B===i.TEXTURE_3D||B===i.TEXTURE_2D_ARRAY?i.texImage3D(he,0,i.RGBA,1,1,Ce,0,i.RGBA,i.UNSIGNED_BYTE,we):i.texImage2D(he+Xe,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,we);return Ae}let Ye={};Ye[i.TEXTURE_2D]=Pe(i.TEXTURE_2D,i.TEXTURE_2D,1),Ye[i.TEXTURE_CUBE_MAP]=Pe(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Ye[i.TEXTURE_2D_ARRAY]=Pe(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Ye[i.TEXTURE_3D]=Pe(i.TEXTURE_3D,i.TEXTURE_3D,1,1),o.setClear(0,0,0,1),c.setClear(1),u.setClear(0),Ue(i.DEPTH_TEST),c.setFunc(Tr),Ct(!1),xt(tc),Ue(i.CULL_FACE),Vt(ir);function Ue(B){m[B]!==!0&&(i.enable(B),m[B]=!0)}function rt(B){m[B]!==!1&&(i.disable(B),m[B]=!1)}function Gt(B,he){return g[B]!==he?(i.bindFramebuffer(B,he),g[B]=he,B===i.DRAW_FRAMEBUFFER&&(g[i.FRAMEBUFFER]=he),B===i.FRAMEBUFFER&&(g[i.DRAW_FRAMEBUFFER]=he),!0):!1}function Ke(B,he){let se=E,Ce=!1;if(B){se=S.get(he),se===void 0&&(se=[],S.set(he,se));let we=B.textures;if(se.length!==we.length||se[0]!==i.COLOR_ATTACHMENT0){for(let Ae=0,Xe=we.length;Ae<Xe;Ae++)se[Ae]=i.COLOR_ATTACHMENT0+Ae;se.length=we.length,Ce=!0}}else se[0]!==i.BACK&&(se[0]=i.BACK,Ce=!0);Ce&&i.drawBuffers(se)}function bt(B){return C!==B?(i.useProgram(B),C=B,!0):!1}let Tt={[rr]:i.FUNC_ADD,[yu]:i.FUNC_SUBTRACT,[xu]:i.FUNC_REVERSE_SUBTRACT};Tt[Su]=i.MIN,Tt[Mu]=i.MAX;let dt={[bu]:i.ZERO,[Eu]:i.ONE,[wu]:i.SRC_COLOR,[sc]:i.SRC_ALPHA,[Iu]:i.SRC_ALPHA_SATURATE,[Cu]:i.DST_COLOR,[Au]:i.DST_ALPHA,[Tu]:i.ONE_MINUS_SRC_COLOR,[ac]:i.ONE_MINUS_SRC_ALPHA,[Pu]:i.ONE_MINUS_DST_COLOR,[Ru]:i.ONE_MINUS_DST_ALPHA,[Du]:i.CONSTANT_COLOR,[Lu]:i.ONE_MINUS_CONSTANT_COLOR,[Fu]:i.CONSTANT_ALPHA,[Nu]:i.ONE_MINUS_CONSTANT_ALPHA};function Vt(B,he,se,Ce,we,Ae,Xe,ot,Ee,qe){if(B===ir){x===!0&&(rt(i.BLEND),x=!1);return}if(x===!1&&(Ue(i.BLEND),x=!0),B!==vu){if(B!==v||qe!==k){if((P!==rr||U!==rr)&&(i.blendEquation(i.FUNC_ADD),P=rr,U=rr),qe)switch(B){case Gr:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case nc:i.blendFunc(i.ONE,i.ONE);break;case ic:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case rc:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:tt("WebGLState: Invalid blending: ",B);break}else switch(B){case Gr:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case nc:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case ic:tt("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case rc:tt("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:tt("WebGLState: Invalid blending: ",B);break}O=null,I=null,N=null,b=null,D.set(0,0,0),q=0,v=B,k=qe}return}we=we||he,Ae=Ae||se,Xe=Xe||Ce,(he!==P||we!==U)&&(i.blendEquationSeparate(Tt[he],Tt[we]),P=he,U=we),(se!==O||Ce!==I||Ae!==N||Xe!==b)&&(i.blendFuncSeparate(dt[se],dt[Ce],dt[Ae],dt[Xe]),O=se,I=Ce,N=Ae,b=Xe),(ot.equals(D)===!1||Ee!==q)&&(i.blendColor(ot.r,ot.g,ot.b,Ee),D.copy(ot),q=Ee),v=B,k=!1}function ut(B,he){B.side===li?rt(i.CULL_FACE):Ue(i.CULL_FACE);let se=B.side===xn;he&&(se=!se),Ct(se),B.blending===Gr&&B.transparent===!1?Vt(ir):Vt(B.blending,B.blendEquation,B.blendSrc,B.blendDst,B.blendEquationAlpha,B.blendSrcAlpha,B.blendDstAlpha,B.blendColor,B.blendAlpha,B.premultipliedAlpha),c.setFunc(B.depthFunc),c.setTest(B.depthTest),c.setMask(B.depthWrite),o.setMask(B.colorWrite);let Ce=B.stencilWrite;u.setTest(Ce),Ce&&(u.setMask(B.stencilWriteMask),u.setFunc(B.stencilFunc,B.stencilRef,B.stencilFuncMask),u.setOp(B.stencilFail,B.stencilZFail,B.stencilZPass)),De(B.polygonOffset,B.polygonOffsetFactor,B.polygonOffsetUnits),B.alphaToCoverage===!0?Ue(i.SAMPLE_ALPHA_TO_COVERAGE):rt(i.SAMPLE_ALPHA_TO_COVERAGE)}function Ct(B){Y!==B&&(B?i.frontFace(i.CW):i.frontFace(i.CCW),Y=B)}function xt(B){B!==mu?(Ue(i.CULL_FACE),B!==J&&(B===tc?i.cullFace(i.BACK):B===gu?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):rt(i.CULL_FACE),J=B}function Qt(B){B!==ee&&(ne&&i.lineWidth(B),ee=B)}function De(B,he,se){B?(Ue(i.POLYGON_OFFSET_FILL),(z!==he||ie!==se)&&(z=he,ie=se,c.getReversed()&&(he=-he,se=-se),i.polygonOffset(he,se))):rt(i.POLYGON_OFFSET_FILL)}function $e(B){B?Ue(i.SCISSOR_TEST):rt(i.SCISSOR_TEST)}function an(B){B===void 0&&(B=i.TEXTURE0+G-1),H!==B&&(i.activeTexture(B),H=B)}function en(B,he,se){se===void 0&&(H===null?se=i.TEXTURE0+G-1:se=H);let Ce=me[se];Ce===void 0&&(Ce={type:void 0,texture:void 0},me[se]=Ce),(Ce.type!==B||Ce.texture!==he)&&(H!==se&&(i.activeTexture(se),H=se),i.bindTexture(B,he||Ye[B]),Ce.type=B,Ce.texture=he)}function W(){let B=me[H];B!==void 0&&B.type!==void 0&&(i.bindTexture(B.type,null),B.type=void 0,B.texture=void 0)}function pn(){try{i.compressedTexImage2D(...arguments)}catch(B){tt("WebGLState:",B)}}function At(){try{i.compressedTexImage3D(...arguments)}catch(B){tt("WebGLState:",B)}}function Ft(){try{i.texSubImage2D(...arguments)}catch(B){tt("WebGLState:",B)}}function Le(){try{i.texSubImage3D(...arguments)}catch(B){tt("WebGLState:",B)}}function Wt(){try{i.compressedTexSubImage2D(...arguments)}catch(B){tt("WebGLState:",B)}}function je(){try{i.compressedTexSubImage3D(...arguments)}catch(B){tt("WebGLState:",B)}}function Ze(){try{i.texStorage2D(...arguments)}catch(B){tt("WebGLState:",B)}}function L(){try{i.texStorage3D(...arguments)}catch(B){tt("WebGLState:",B)}}function T(){try{i.texImage2D(...arguments)}catch(B){tt("WebGLState:",B)}}function Z(){try{i.texImage3D(...arguments)}catch(B){tt("WebGLState:",B)}}function ve(B){return y[B]!==void 0?y[B]:i.getParameter(B)}function de(B,he){y[B]!==he&&(i.pixelStorei(B,he),y[B]=he)}function pe(B){ue.equals(B)===!1&&(i.scissor(B.x,B.y,B.z,B.w),ue.copy(B))}function Me(B){Fe.equals(B)===!1&&(i.viewport(B.x,B.y,B.z,B.w),Fe.copy(B))}function ae(B,he){let se=d.get(he);se===void 0&&(se=new WeakMap,d.set(he,se));let Ce=se.get(B);Ce===void 0&&(Ce=i.getUniformBlockIndex(he,B.name),i.uniformBlockBinding(he,Ce,Ce),se.set(B,Ce))}function le(B,he,se){let we=d.get(he).get(B);f[we]!==se&&(i.bindBufferBase(i.UNIFORM_BUFFER,we,se),f[we]=se)}function Re(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),c.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),m={},y={},H=null,me={},g={},f={},S=new WeakMap,E=[],C=null,x=!1,v=null,P=null,O=null,I=null,U=null,N=null,b=null,D=new ct(0,0,0),q=0,k=!1,Y=null,J=null,ee=null,z=null,ie=null,ue.set(0,0,i.canvas.width,i.canvas.height),Fe.set(0,0,i.canvas.width,i.canvas.height),o.reset(),c.reset(),u.reset()}return{buffers:{color:o,depth:c,stencil:u},enable:Ue,disable:rt,bindFramebuffer:Gt,drawBuffers:Ke,useProgram:bt,setBlending:Vt,setMaterial:ut,setFlipSided:Ct,setCullFace:xt,setLineWidth:Qt,setPolygonOffset:De,setScissorTest:$e,activeTexture:an,bindTexture:en,unbindTexture:W,compressedTexImage2D:pn,compressedTexImage3D:At,texImage2D:T,texImage3D:Z,pixelStorei:de,getParameter:ve,updateUBOMapping:ae,uniformBlockBinding:le,texStorage2D:Ze,texStorage3D:L,texSubImage2D:Ft,texSubImage3D:Le,compressedTexSubImage2D:Wt,compressedTexSubImage3D:je,scissor:pe,viewport:Me,reset:Re}}function DM(i,e,t,n,s,o,c){let u=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,f=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),d=new et,m=new WeakMap,y=new Set,g,S=new WeakMap,E=new Set,C=new FinalizationRegistry(L=>E.delete(L)),x=!1;try{x=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function v(L,T){return x?new OffscreenCanvas(L,T):hs("canvas")}function P(L,T,Z){let ve=1,de=Ze(L);if((de.width>Z||de.height>Z)&&(ve=Z/Math.max(de.width,de.height)),ve<1)if(typeof HTMLImageElement<"u"&&L instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&L instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&L instanceof ImageBitmap||typeof VideoFrame<"u"&&L instanceof VideoFrame){let pe=Math.floor(ve*de.width),Me=Math.floor(ve*de.height);g===void 0&&(g=v(pe,Me));let ae=T?v(pe,Me):g;return ae.width=pe,ae.height=Me,ae.getContext("2d").drawImage(L,0,0,pe,Me),Qe("WebGLRenderer: Texture has been resized from ("+de.width+"x"+de.height+") to ("+pe+"x"+Me+")."),ae}else return"data"in L&&Qe("WebGLRenderer: Image in DataTexture is too big ("+de.width+"x"+de.height+")."),L;return L}function O(L){return L.generateMipmaps}function I(L){i.generateMipmap(L)}function U(L){return L.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:L.isWebGL3DRenderTarget?i.TEXTURE_3D:L.isWebGLArrayRenderTarget||L.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function N(L,T,Z,ve,de,pe=!1){if(L!==null){if(i[L]!==void 0)return i[L];Qe("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+L+"'")}let Me;ve&&(Me=e.get("EXT_texture_norm16"),Me||Qe("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let ae=T;if(T===i.RED&&(Z===i.FLOAT&&(ae=i.R32F),Z===i.HALF_FLOAT&&(ae=i.R16F),Z===i.UNSIGNED_BYTE&&(ae=i.R8),Z===i.UNSIGNED_SHORT&&Me&&(ae=Me.R16_EXT),Z===i.SHORT&&Me&&(ae=Me.R16_SNORM_EXT)),T===i.RED_INTEGER&&(Z===i.UNSIGNED_BYTE&&(ae=i.R8UI),Z===i.UNSIGNED_SHORT&&(ae=i.R16UI),Z===i.UNSIGNED_INT&&(ae=i.R32UI),Z===i.BYTE&&(ae=i.R8I),Z===i.SHORT&&(ae=i.R16I),Z===i.INT&&(ae=i.R32I)),T===i.RG&&(Z===i.FLOAT&&(ae=i.RG32F),Z===i.HALF_FLOAT&&(ae=i.RG16F),Z===i.UNSIGNED_BYTE&&(ae=i.RG8),Z===i.UNSIGNED_SHORT&&Me&&(ae=Me.RG16_EXT),Z===i.SHORT&&Me&&(ae=Me.RG16_SNORM_EXT)),T===i.RG_INTEGER&&(Z===i.UNSIGNED_BYTE&&(ae=i.RG8UI),Z===i.UNSIGNED_SHORT&&(ae=i.RG16UI),Z===i.UNSIGNED_INT&&(ae=i.RG32UI),Z===i.BYTE&&(ae=i.RG8I),Z===i.SHORT&&(ae=i.RG16I),Z===i.INT&&(ae=i.RG32I)),T===i.RGB_INTEGER&&(Z===i.UNSIGNED_BYTE&&(ae=i.RGB8UI),Z===i.UNSIGNED_SHORT&&(ae=i.RGB16UI),Z===i.UNSIGNED_INT&&(ae=i.RGB32UI),Z===i.BYTE&&(ae=i.RGB8I),Z===i.SHORT&&(ae=i.RGB16I),Z===i.INT&&(ae=i.RGB32I)),T===i.RGBA_INTEGER&&(Z===i.UNSIGNED_BYTE&&(ae=i.RGBA8UI),Z===i.UNSIGNED_SHORT&&(ae=i.RGBA16UI),Z===i.UNSIGNED_INT&&(ae=i.RGBA32UI),Z===i.BYTE&&(ae=i.RGBA8I),Z===i.SHORT&&(ae=i.RGBA16I),Z===i.INT&&(ae=i.RGBA32I)),T===i.RGB&&(Z===i.UNSIGNED_SHORT&&Me&&(ae=Me.RGB16_EXT),Z===i.SHORT&&Me&&(ae=Me.RGB16_SNORM_EXT),Z===i.UNSIGNED_INT_5_9_9_9_REV&&(ae=i.RGB9_E5),Z===i.UNSIGNED_INT_10F_11F_11F_REV&&(ae=i.R11F_G11F_B10F)),T===i.RGBA){let le=pe?cs:yt.getTransfer(de);Z===i.FLOAT&&(ae=i.RGBA32F),Z===i.HALF_FLOAT&&(ae=i.RGBA16F),Z===i.UNSIGNED_BYTE&&(ae=le===Rt?i.SRGB8_ALPHA8:i.RGBA8),Z===i.UNSIGNED_SHORT&&Me&&(ae=Me.RGBA16_EXT),Z===i.SHORT&&Me&&(ae=Me.RGBA16_SNORM_EXT),Z===i.UNSIGNED_SHORT_4_4_4_4&&(ae=i.RGBA4),Z===i.UNSIGNED_SHORT_5_5_5_1&&(ae=i.RGB5_A1)}return(ae===i.R16F||ae===i.R32F||ae===i.RG16F||ae===i.RG32F||ae===i.RGBA16F||ae===i.RGBA32F)&&e.get("EXT_color_buffer_float"),ae}function b(L,T){let Z;return L?T===null||T===Wn||T===ar?Z=i.DEPTH24_STENCIL8:T===Xn?Z=i.DEPTH32F_STENCIL8:T===Hr&&(Z=i.DEPTH24_STENCIL8,Qe("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):T===null||T===Wn||T===ar?Z=i.DEPTH_COMPONENT24:T===Xn?Z=i.DEPTH_COMPONENT32F:T===Hr&&(Z=i.DEPTH_COMPONENT16),Z}function D(L,T){return O(L)===!0||L.isFramebufferTexture&&L.minFilter!==sn&&L.minFilter!==vn?Math.log2(Math.max(T.width,T.height))+1:L.mipmaps.length>0?L.mipmaps.length:L.isCompressedTexture&&Array.isArray(L.image)?T.mipmaps.length:1}function q(L){let T=new WeakRef(L);n.get(L).__ref=T,E.add(T),C.register(L,T,T)}function k(L){let T=n.get(L).__ref;T!==void 0&&(E.delete(T),C.unregister(T))}function Y(L){ee(L.target)}function J(L){z(L.target)}function ee(L){L.removeEventListener("dispose",Y),k(L),G(L),L.isVideoTexture&&m.delete(L),L.isHTMLTexture&&y.delete(L)}function z(L){L.removeEventListener("dispose",J),k(L),Se(L)}function ie(){for(let L of E){let T=L.deref();T!==void 0&&(T.isRenderTarget===!0?z(T):ee(T))}E.clear(),y.clear()}function G(L){let T=n.get(L);if(T.__webglInit===void 0)return;let Z=L.source,ve=S.get(Z);if(ve){let de=ve[T.__cacheKey];de.usedTimes--,de.usedTimes===0&&ne(L),Object.keys(ve).length===0&&S.delete(Z)}n.remove(L)}function ne(L){let T=n.get(L);i.deleteTexture(T.__webglTexture);let Z=L.source,ve=S.get(Z);delete ve[T.__cacheKey],c.memory.textures--}function Se(L){let T=n.get(L);T.__depthDisposeCallback&&T.__depthDisposeCallback();let Z=L.depthTexture;if(Z&&Z.renderTarget===L&&ee(Z),L.isWebGLCubeRenderTarget)for(let de=0;de<6;de++){if(Array.isArray(T.__webglFramebuffer[de]))for(let pe=0;pe<T.__webglFramebuffer[de].length;pe++)i.deleteFramebuffer(T.__webglFramebuffer[de][pe]);else i.deleteFramebuffer(T.__webglFramebuffer[de]);T.__webglDepthbuffer&&i.deleteRenderbuffer(T.__webglDepthbuffer[de])}else{if(Array.isArray(T.__webglFramebuffer))for(let de=0;de<T.__webglFramebuffer.length;de++)i.deleteFramebuffer(T.__webglFramebuffer[de]);else i.deleteFramebuffer(T.__webglFramebuffer);if(T.__webglDepthbuffer&&i.deleteRenderbuffer(T.__webglDepthbuffer),T.__webglMultisampledFramebuffer&&i.deleteFramebuffer(T.__webglMultisampledFramebuffer),T.__webglColorRenderbuffer)for(let de=0;de<T.__webglColorRenderbuffer.length;de++)T.__webglColorRenderbuffer[de]&&i.deleteRenderbuffer(T.__webglColorRenderbuffer[de]);T.__webglDepthRenderbuffer&&i.deleteRenderbuffer(T.__webglDepthRenderbuffer)}let ve=L.textures;for(let de=0,pe=ve.length;de<pe;de++){let Me=n.get(ve[de]);Me.__webglTexture&&(i.deleteTexture(Me.__webglTexture),c.memory.textures--),n.remove(ve[de])}n.remove(L)}let re=0;function H(){re=0}function me(){return re}function We(L){re=L}function nt(){let L=re;return L>=s.maxTextures&&Qe("WebGLTextures: Trying to use "+(L+1)+" texture units while this GPU supports only "+s.maxTextures),re+=1,L}function ue(L){let T=[];return T.push(L.wrapS),T.push(L.wrapT),T.push(L.wrapR||0),T.push(L.magFilter),T.push(L.minFilter),T.push(L.anisotropy),T.push(L.internalFormat),T.push(L.format),T.push(L.type),T.push(L.generateMipmaps),T.push(L.mipmapsAutoUpdate),T.push(L.premultiplyAlpha),T.push(L.flipY),T.push(L.unpackAlignment),T.push(L.colorSpace),T.join()}function Fe(L,T){let Z=n.get(L);if(L.isVideoTexture&&Wt(L),L.isRenderTargetTexture===!1&&L.isExternalTexture!==!0&&L.version>0&&Z.__version!==L.version){let ve=L.image;if(ve===null)Qe("WebGLRenderer: Texture marked for update but no image data found.");else if(ve.complete===!1)Qe("WebGLRenderer: Texture marked for update but image is incomplete");else{ut(Z,L,T);return}}else L.isExternalTexture&&(Z.__webglTexture=L.sourceTexture?L.sourceTexture:null);t.bindTexture(i.TEXTURE_2D,Z.__webglTexture,i.TEXTURE0+T)}function Pe(L,T){let Z=n.get(L);if(L.isRenderTargetTexture===!1&&L.version>0&&Z.__version!==L.version){ut(Z,L,T);return}else L.isExternalTexture&&(Z.__webglTexture=L.sourceTexture?L.sourceTexture:null);t.bindTexture(i.TEXTURE_2D_ARRAY,Z.__webglTexture,i.TEXTURE0+T)}function Ye(L,T){let Z=n.get(L);if(L.isRenderTargetTexture===!1&&L.version>0&&Z.__version!==L.version){ut(Z,L,T);return}t.bindTexture(i.TEXTURE_3D,Z.__webglTexture,i.TEXTURE0+T)}function Ue(L,T){let Z=n.get(L);if(L.version>0&&Z.__version!==L.version){Ct(Z,L,T);return}t.bindTexture(i.TEXTURE_CUBE_MAP,Z.__webglTexture,i.TEXTURE0+T)}let rt={[Ar]:i.REPEAT,[ii]:i.CLAMP_TO_EDGE,[Ha]:i.MIRRORED_REPEAT},Gt={[sn]:i.NEAREST,[Bu]:i.NEAREST_MIPMAP_NEAREST,[Ns]:i.NEAREST_MIPMAP_LINEAR,[vn]:i.LINEAR,[mo]:i.LINEAR_MIPMAP_NEAREST,[Hn]:i.LINEAR_MIPMAP_LINEAR},Ke={[Vu]:i.NEVER,[wc]:i.ALWAYS,[Hu]:i.LESS,[bc]:i.LEQUAL,[Wu]:i.EQUAL,[Ec]:i.GEQUAL,[Xu]:i.GREATER,[$u]:i.NOTEQUAL};function bt(L,T){if(T.type===Xn&&e.has("OES_texture_float_linear")===!1&&(T.magFilter===vn||T.magFilter===mo||T.magFilter===Ns||T.magFilter===Hn||T.minFilter===vn||T.minFilter===mo||T.minFilter===Ns||T.minFilter===Hn)&&Qe("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(L,i.TEXTURE_WRAP_S,rt[T.wrapS]),i.texParameteri(L,i.TEXTURE_WRAP_T,rt[T.wrapT]),(L===i.TEXTURE_3D||L===i.TEXTURE_2D_ARRAY)&&i.texParameteri(L,i.TEXTURE_WRAP_R,rt[T.wrapR]),i.texParameteri(L,i.TEXTURE_MAG_FILTER,Gt[T.magFilter]),i.texParameteri(L,i.TEXTURE_MIN_FILTER,Gt[T.minFilter]),T.compareFunction&&(i.texParameteri(L,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(L,i.TEXTURE_COMPARE_FUNC,Ke[T.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(T.magFilter===sn||T.minFilter!==Ns&&T.minFilter!==Hn||T.type===Xn&&e.has("OES_texture_float_linear")===!1)return;if(T.anisotropy>1||n.get(T).__currentAnisotropy){let Z=e.get("EXT_texture_filter_anisotropic");i.texParameterf(L,Z.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(T.anisotropy,s.getMaxAnisotropy())),n.get(T).__currentAnisotropy=T.anisotropy}}}function Tt(L,T){let Z=!1;L.__webglInit===void 0&&(L.__webglInit=!0,T.addEventListener("dispose",Y),q(T));let ve=T.source,de=S.get(ve);de===void 0&&(de={},S.set(ve,de));let pe=ue(T);if(pe!==L.__cacheKey){de[pe]===void 0&&(de[pe]={texture:i.createTexture(),usedTimes:0},c.memory.textures++,Z=!0),de[pe].usedTimes++;let Me=de[L.__cacheKey];Me!==void 0&&(de[L.__cacheKey].usedTimes--,Me.usedTimes===0&&ne(T)),L.__cacheKey=pe,L.__webglTexture=de[pe].texture}return Z}function dt(L,T,Z){return Math.floor(Math.floor(L/Z)/T)}function Vt(L,T,Z,ve){let pe=L.updateRanges;if(pe.length===0)t.texSubImage2D(i.TEXTURE_2D,0,0,0,T.width,T.height,Z,ve,T.data);else{pe.sort((B,he)=>B.start-he.start);let Me=0;for(let B=1;B<pe.length;B++){let he=pe[Me],se=pe[B],Ce=he.start+he.count,we=dt(se.start,T.width,4),Ae=dt(he.start,T.width,4);se.start<=Ce+1&&we===Ae&&dt(se.start+se.count-1,T.width,4)===we?he.count=Math.max(he.count,se.start+se.count-he.start):(++Me,pe[Me]=se)}pe.length=Me+1;let ae=t.getParameter(i.UNPACK_ROW_LENGTH),le=t.getParameter(i.UNPACK_SKIP_PIXELS),Re=t.getParameter(i.UNPACK_SKIP_ROWS);t.pixelStorei(i.UNPACK_ROW_LENGTH,T.width);for(let B=0,he=pe.length;B<he;B++){let se=pe[B],Ce=Math.floor(se.start/4),we=Math.ceil(se.count/4),Ae=Ce%T.width,Xe=Math.floor(Ce/T.width),ot=we,Ee=1;t.pixelStorei(i.UNPACK_SKIP_PIXELS,Ae),t.pixelStorei(i.UNPACK_SKIP_ROWS,Xe),t.texSubImage2D(i.TEXTURE_2D,0,Ae,Xe,ot,Ee,Z,ve,T.data)}L.clearUpdateRanges(),t.pixelStorei(i.UNPACK_ROW_LENGTH,ae),t.pixelStorei(i.UNPACK_SKIP_PIXELS,le),t.pixelStorei(i.UNPACK_SKIP_ROWS,Re)}}function ut(L,T,Z){let ve=i.TEXTURE_2D;(T.isDataArrayTexture||T.isCompressedArrayTexture)&&(ve=i.TEXTURE_2D_ARRAY),T.isData3DTexture&&(ve=i.TEXTURE_3D);let de=Tt(L,T),pe=T.source;t.bindTexture(ve,L.__webglTexture,i.TEXTURE0+Z);let Me=n.get(pe);if(pe.version!==Me.__version||de===!0){if(t.activeTexture(i.TEXTURE0+Z),(typeof ImageBitmap<"u"&&T.image instanceof ImageBitmap)===!1){let Ee=yt.getPrimaries(yt.workingColorSpace),qe=T.colorSpace===Ei?null:yt.getPrimaries(T.colorSpace),lt=T.colorSpace===Ei||Ee===qe?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,T.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,T.premultiplyAlpha),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,lt)}t.pixelStorei(i.UNPACK_ALIGNMENT,T.unpackAlignment);let le=P(T.image,!1,s.maxTextureSize);le=je(T,le);let Re=o.convert(T.format,T.colorSpace),B=o.convert(T.type),he=N(T.internalFormat,Re,B,T.normalized,T.colorSpace,T.isVideoTexture);bt(ve,T);let se,Ce=T.mipmaps,we=T.isVideoTexture!==!0,Ae=Me.__version===void 0||de===!0,Xe=pe.dataReady,ot=D(T,le);if(T.isDepthTexture)he=b(T.format===bi,T.type),Ae&&(we?t.texStorage2D(i.TEXTURE_2D,1,he,le.width,le.height):t.texImage2D(i.TEXTURE_2D,0,he,le.width,le.height,0,Re,B,null));else if(T.isDataTexture)if(Ce.length>0){we&&Ae&&t.texStorage2D(i.TEXTURE_2D,ot,he,Ce[0].width,Ce[0].height);for(let Ee=0,qe=Ce.length;Ee<qe;Ee++)se=Ce[Ee],we?Xe&&t.texSubImage2D(i.TEXTURE_2D,Ee,0,0,se.width,se.height,Re,B,se.data):t.texImage2D(i.TEXTURE_2D,Ee,he,se.width,se.height,0,Re,B,se.data);T.generateMipmaps=!1}else we?(Ae&&t.texStorage2D(i.TEXTURE_2D,ot,he,le.width,le.height),Xe&&Vt(T,le,Re,B)):t.texImage2D(i.TEXTURE_2D,0,he,le.width,le.height,0,Re,B,le.data);else if(T.isCompressedTexture)if(T.isCompressedArrayTexture){we&&Ae&&t.texStorage3D(i.TEXTURE_2D_ARRAY,ot,he,Ce[0].width,Ce[0].height,le.depth);for(let Ee=0,qe=Ce.length;Ee<qe;Ee++)if(se=Ce[Ee],T.format!==qn)if(Re!==null)if(we){if(Xe)if(T.layerUpdates.size>0){let lt=Nc(se.width,se.height,T.format,T.type);for(let Oe of T.layerUpdates){let Et=se.data.subarray(Oe*lt/se.data.BYTES_PER_ELEMENT,(Oe+1)*lt/se.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,Ee,0,0,Oe,se.width,se.height,1,Re,Et)}}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,Ee,0,0,0,se.width,se.height,le.depth,Re,se.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,Ee,he,se.width,se.height,le.depth,0,se.data,0,0);else Qe("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else we?Xe&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,Ee,0,0,0,se.width,se.height,le.depth,Re,B,se.data):t.texImage3D(i.TEXTURE_2D_ARRAY,Ee,he,se.width,se.height,le.depth,0,Re,B,se.data);T.layerUpdates.size>0&&T.clearLayerUpdates()}else{we&&Ae&&t.texStorage2D(i.TEXTURE_2D,ot,he,Ce[0].width,Ce[0].height);for(let Ee=0,qe=Ce.length;Ee<qe;Ee++)se=Ce[Ee],T.format!==qn?Re!==null?we?Xe&&t.compressedTexSubImage2D(i.TEXTURE_2D,Ee,0,0,se.width,se.height,Re,se.data):t.compressedTexImage2D(i.TEXTURE_2D,Ee,he,se.width,se.height,0,se.data):Qe("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):we?Xe&&t.texSubImage2D(i.TEXTURE_2D,Ee,0,0,se.width,se.height,Re,B,se.data):t.texImage2D(i.TEXTURE_2D,Ee,he,se.width,se.height,0,Re,B,se.data)}else if(T.isDataArrayTexture)if(we){if(Ae&&t.texStorage3D(i.TEXTURE_2D_ARRAY,ot,he,le.width,le.height,le.depth),Xe)if(T.layerUpdates.size>0){let Ee=Nc(le.width,le.height,T.format,T.type);for(let qe of T.layerUpdates){let lt=le.data.subarray(qe*Ee/le.data.BYTES_PER_ELEMENT,(qe+1)*Ee/le.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,qe,le.width,le.height,1,Re,B,lt)}T.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,le.width,le.height,le.depth,Re,B,le.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,he,le.width,le.height,le.depth,0,Re,B,le.data);else if(T.isData3DTexture)we?(Ae&&t.texStorage3D(i.TEXTURE_3D,ot,he,le.width,le.height,le.depth),Xe&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,le.width,le.height,le.depth,Re,B,le.data)):t.texImage3D(i.TEXTURE_3D,0,he,le.width,le.height,le.depth,0,Re,B,le.data);else if(T.isFramebufferTexture){if(Ae)if(we)t.texStorage2D(i.TEXTURE_2D,ot,he,le.width,le.height);else{let Ee=le.width,qe=le.height;for(let lt=0;lt<ot;lt++)t.texImage2D(i.TEXTURE_2D,lt,he,Ee,qe,0,Re,B,null),Ee>>=1,qe>>=1}}else if(T.isHTMLTexture){if("texElementImage2D"in i){let Ee=i.canvas;if(Ee.hasAttribute("layoutsubtree")||Ee.setAttribute("layoutsubtree","true"),le.parentNode!==Ee){Ee.appendChild(le),y.add(T),Ee.onpaint=qe=>{let lt=qe.changedElements;for(let Oe of y)lt.includes(Oe.image)&&(Oe.needsUpdate=!0)},Ee.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,le);else{let lt=i.RGBA,Oe=i.RGBA,Et=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,lt,Oe,Et,le)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(Ce.length>0){if(we&&Ae){let Ee=Ze(Ce[0]);t.texStorage2D(i.TEXTURE_2D,ot,he,Ee.width,Ee.height)}for(let Ee=0,qe=Ce.length;Ee<qe;Ee++)se=Ce[Ee],we?Xe&&t.texSubImage2D(i.TEXTURE_2D,Ee,0,0,Re,B,se):t.texImage2D(i.TEXTURE_2D,Ee,he,Re,B,se);T.generateMipmaps=!1}else if(we){if(Ae){let Ee=Ze(le);t.texStorage2D(i.TEXTURE_2D,ot,he,Ee.width,Ee.height)}Xe&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,Re,B,le)}else t.texImage2D(i.TEXTURE_2D,0,he,Re,B,le);O(T)&&T.mipmapsAutoUpdate===!0&&I(ve),Me.__version=pe.version,T.onUpdate&&T.onUpdate(T)}L.__version=T.version}function Ct(L,T,Z){if(T.image.length!==6)return;let ve=Tt(L,T),de=T.source;t.bindTexture(i.TEXTURE_CUBE_MAP,L.__webglTexture,i.TEXTURE0+Z);let pe=n.get(de);if(de.version!==pe.__version||ve===!0){t.activeTexture(i.TEXTURE0+Z);let Me=yt.getPrimaries(yt.workingColorSpace),ae=T.colorSpace===Ei?null:yt.getPrimaries(T.colorSpace),le=T.colorSpace===Ei||Me===ae?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,T.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,T.premultiplyAlpha),t.pixelStorei(i.UNPACK_ALIGNMENT,T.unpackAlignment),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,le);let Re=T.isCompressedTexture||T.image[0].isCompressedTexture,B=T.image[0]&&T.image[0].isDataTexture,he=[];for(let Oe=0;Oe<6;Oe++)!Re&&!B?he[Oe]=P(T.image[Oe],!0,s.maxCubemapSize):he[Oe]=B?T.image[Oe].image:T.image[Oe],he[Oe]=je(T,he[Oe]);let se=he[0],Ce=o.convert(T.format,T.colorSpace),we=o.convert(T.type),Ae=N(T.internalFormat,Ce,we,T.normalized,T.colorSpace),Xe=T.isVideoTexture!==!0,ot=pe.__version===void 0||ve===!0,Ee=de.dataReady,qe=D(T,se);bt(i.TEXTURE_CUBE_MAP,T);let lt;if(T.isDepthTexture){if(Ae=b(T.format===bi,T.type),ot)if(Xe)t.texStorage2D(i.TEXTURE_CUBE_MAP,1,Ae,se.width,se.height);else for(let Oe=0;Oe<6;Oe++)t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,0,Ae,se.width,se.height,0,Ce,we,null)}else if(Re){Xe&&ot&&t.texStorage2D(i.TEXTURE_CUBE_MAP,qe,Ae,se.width,se.height);for(let Oe=0;Oe<6;Oe++){lt=he[Oe].mipmaps;for(let Et=0;Et<lt.length;Et++){let Ut=lt[Et];T.format!==qn?Ce!==null?Xe?Ee&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et,0,0,Ut.width,Ut.height,Ce,Ut.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et,Ae,Ut.width,Ut.height,0,Ut.data):Qe("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Xe?Ee&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et,0,0,Ut.width,Ut.height,Ce,we,Ut.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et,Ae,Ut.width,Ut.height,0,Ce,we,Ut.data)}}}else{if(lt=T.mipmaps,Xe&&ot){lt.length>0&&qe++;let Oe=Ze(he[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,qe,Ae,Oe.width,Oe.height)}for(let Oe=0;Oe<6;Oe++)if(B){Xe?Ee&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,0,0,0,he[Oe].width,he[Oe].height,Ce,we,he[Oe].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,0,Ae,he[Oe].width,he[Oe].height,0,Ce,we,he[Oe].data);for(let Et=0;Et<lt.length;Et++){let di=lt[Et].image[Oe].image;Xe?Ee&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et+1,0,0,di.width,di.height,Ce,we,di.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et+1,Ae,di.width,di.height,0,Ce,we,di.data)}}else{Xe?Ee&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,0,0,0,Ce,we,he[Oe]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,0,Ae,Ce,we,he[Oe]);for(let Et=0;Et<lt.length;Et++){let Ut=lt[Et];Xe?Ee&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et+1,0,0,Ce,we,Ut.image[Oe]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+Oe,Et+1,Ae,Ce,we,Ut.image[Oe])}}}O(T)&&T.mipmapsAutoUpdate===!0&&I(i.TEXTURE_CUBE_MAP),pe.__version=de.version,T.onUpdate&&T.onUpdate(T)}L.__version=T.version}function xt(L,T,Z,ve,de,pe){let Me=o.convert(Z.format,Z.colorSpace),ae=o.convert(Z.type),le=N(Z.internalFormat,Me,ae,Z.normalized,Z.colorSpace),Re=n.get(T),B=n.get(Z);if(B.__renderTarget=T,!Re.__hasExternalTextures){let he=Math.max(1,T.width>>pe),se=Math.max(1,T.height>>pe);de===i.TEXTURE_3D||de===i.TEXTURE_2D_ARRAY?t.texImage3D(de,pe,le,he,se,T.depth,0,Me,ae,null):t.texImage2D(de,pe,le,he,se,0,Me,ae,null)}t.bindFramebuffer(i.FRAMEBUFFER,L),Le(T)?u.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,ve,de,B.__webglTexture,0,Ft(T)):(de===i.TEXTURE_2D||de>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&de<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,ve,de,B.__webglTexture,pe),t.bindFramebuffer(i.FRAMEBUFFER,null)}function Qt(L,T,Z){if(i.bindRenderbuffer(i.RENDERBUFFER,L),T.depthBuffer){let ve=T.depthTexture,de=ve&&ve.isDepthTexture?ve.type:null,pe=b(T.stencilBuffer,de),Me=T.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;Le(T)?u.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,Ft(T),pe,T.width,T.height):Z?i.renderbufferStorageMultisample(i.RENDERBUFFER,Ft(T),pe,T.width,T.height):i.renderbufferStorage(i.RENDERBUFFER,pe,T.width,T.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,Me,i.RENDERBUFFER,L)}else{let ve=T.textures;for(let de=0;de<ve.length;de++){let pe=ve[de],Me=o.convert(pe.format,pe.colorSpace),ae=o.convert(pe.type),le=N(pe.internalFormat,Me,ae,pe.normalized,pe.colorSpace);Le(T)?u.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,Ft(T),le,T.width,T.height):Z?i.renderbufferStorageMultisample(i.RENDERBUFFER,Ft(T),le,T.width,T.height):i.renderbufferStorage(i.RENDERBUFFER,le,T.width,T.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function De(L,T,Z){let ve=T.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(i.FRAMEBUFFER,L),!(T.depthTexture&&T.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let de=n.get(T.depthTexture);de.__renderTarget=T;let pe=ve?T.depthTexture.image[0]:T.depthTexture.image;(!de.__webglTexture||pe.width!==T.width||pe.height!==T.height)&&(pe.width=T.width,pe.height=T.height,T.depthTexture.needsUpdate=!0),ve?Ue(T.depthTexture,0):Fe(T.depthTexture,0);let Me=de.__webglTexture,ae=Ft(T),le=ve?i.TEXTURE_CUBE_MAP_POSITIVE_X+Z:i.TEXTURE_2D,Re=T.depthTexture.format===bi?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(T.depthTexture.format===xi)Le(T)?u.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,Re,le,Me,0,ae):i.framebufferTexture2D(i.FRAMEBUFFER,Re,le,Me,0);else if(T.depthTexture.format===bi)Le(T)?u.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,Re,le,Me,0,ae):i.framebufferTexture2D(i.FRAMEBUFFER,Re,le,Me,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function $e(L){let T=n.get(L),Z=L.isWebGLCubeRenderTarget===!0;if(T.__boundDepthTexture!==L.depthTexture){let ve=L.depthTexture;if(T.__depthDisposeCallback&&T.__depthDisposeCallback(),ve){let de=()=>{delete T.__boundDepthTexture,delete T.__depthDisposeCallback,ve.removeEventListener("dispose",de)};ve.addEventListener("dispose",de),T.__depthDisposeCallback=de}T.__boundDepthTexture=ve}if(L.depthTexture&&!T.__autoAllocateDepthBuffer)if(Z)for(let ve=0;ve<6;ve++)De(T.__webglFramebuffer[ve],L,ve);else L.texture.mipmaps.length>0?De(T.__webglFramebuffer[0],L,0):De(T.__webglFramebuffer,L,0);else if(Z){T.__webglDepthbuffer=[];for(let ve=0;ve<6;ve++)if(t.bindFramebuffer(i.FRAMEBUFFER,T.__webglFramebuffer[ve]),T.__webglDepthbuffer[ve]===void 0)T.__webglDepthbuffer[ve]=i.createRenderbuffer(),Qt(T.__webglDepthbuffer[ve],L,!1);else{let de=L.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,pe=T.__webglDepthbuffer[ve];i.bindRenderbuffer(i.RENDERBUFFER,pe),i.framebufferRenderbuffer(i.FRAMEBUFFER,de,i.RENDERBUFFER,pe)}}else if(L.texture.mipmaps.length>0?t.bindFramebuffer(i.FRAMEBUFFER,T.__webglFramebuffer[0]):t.bindFramebuffer(i.FRAMEBUFFER,T.__webglFramebuffer),T.__webglDepthbuffer===void 0)T.__webglDepthbuffer=i.createRenderbuffer(),Qt(T.__webglDepthbuffer,L,!1);else{let de=L.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,pe=T.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,pe),i.framebufferRenderbuffer(i.FRAMEBUFFER,de,i.RENDERBUFFER,pe)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function an(L,T,Z){let ve=n.get(L);T!==void 0&&xt(ve.__webglFramebuffer,L,L.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),Z!==void 0&&$e(L)}function en(L){let T=L.texture,Z=n.get(L),ve=n.get(T);L.addEventListener("dispose",J),q(L);let de=L.textures,pe=L.isWebGLCubeRenderTarget===!0,Me=de.length>1;if(Me||(ve.__webglTexture===void 0&&(ve.__webglTexture=i.createTexture()),ve.__version=T.version,c.memory.textures++),pe){Z.__webglFramebuffer=[];for(let ae=0;ae<6;ae++)if(T.mipmaps.length>0){Z.__webglFramebuffer[ae]=[];for(let le=0;le<T.mipmaps.length;le++)Z.__webglFramebuffer[ae][le]=i.createFramebuffer()}else Z.__webglFramebuffer[ae]=i.createFramebuffer()}else{if(T.mipmaps.length>0){Z.__webglFramebuffer=[];for(let ae=0;ae<T.mipmaps.length;ae++)Z.__webglFramebuffer[ae]=i.createFramebuffer()}else Z.__webglFramebuffer=i.createFramebuffer();if(Me)for(let ae=0,le=de.length;ae<le;ae++){let Re=n.get(de[ae]);Re.__webglTexture===void 0&&(Re.__webglTexture=i.createTexture(),c.memory.textures++)}if(L.samples>0&&Le(L)===!1){Z.__webglMultisampledFramebuffer=i.createFramebuffer(),Z.__webglColorRenderbuffer=[],t.bindFramebuffer(i.FRAMEBUFFER,Z.__webglMultisampledFramebuffer);for(let ae=0;ae<de.length;ae++){let le=de[ae];Z.__webglColorRenderbuffer[ae]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,Z.__webglColorRenderbuffer[ae]);let Re=o.convert(le.format,le.colorSpace),B=o.convert(le.type),he=N(le.internalFormat,Re,B,le.normalized,le.colorSpace,L.isXRRenderTarget===!0),se=Ft(L);i.renderbufferStorageMultisample(i.RENDERBUFFER,se,he,L.width,L.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+ae,i.RENDERBUFFER,Z.__webglColorRenderbuffer[ae])}i.bindRenderbuffer(i.RENDERBUFFER,null),L.depthBuffer&&(Z.__webglDepthRenderbuffer=i.createRenderbuffer(),Qt(Z.__webglDepthRenderbuffer,L,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(pe){t.bindTexture(i.TEXTURE_CUBE_MAP,ve.__webglTexture),bt(i.TEXTURE_CUBE_MAP,T);for(let ae=0;ae<6;ae++)if(T.mipmaps.length>0)for(let le=0;le<T.mipmaps.length;le++)xt(Z.__webglFramebuffer[ae][le],L,T,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+ae,le);else xt(Z.__webglFramebuffer[ae],L,T,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+ae,0);O(T)?I(i.TEXTURE_CUBE_MAP):T.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,T.mipmaps.length-1),t.unbindTexture()}else if(Me){for(let ae=0,le=de.length;ae<le;ae++){let Re=de[ae],B=n.get(Re),he=i.TEXTURE_2D;(L.isWebGL3DRenderTarget||L.isWebGLArrayRenderTarget)&&(he=L.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(he,B.__webglTexture),bt(he,Re),xt(Z.__webglFramebuffer,L,Re,i.COLOR_ATTACHMENT0+ae,he,0),O(Re)&&I(he)}t.unbindTexture()}else{let ae=i.TEXTURE_2D;if((L.isWebGL3DRenderTarget||L.isWebGLArrayRenderTarget)&&(ae=L.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(ae,ve.__webglTexture),bt(ae,T),T.mipmaps.length>0)for(let le=0;le<T.mipmaps.length;le++)xt(Z.__webglFramebuffer[le],L,T,i.COLOR_ATTACHMENT0,ae,le);else xt(Z.__webglFramebuffer,L,T,i.COLOR_ATTACHMENT0,ae,0);O(T)?I(ae):T.mipmaps.length>0&&i.texParameteri(ae,i.TEXTURE_MAX_LEVEL,T.mipmaps.length-1),t.unbindTexture()}L.depthBuffer&&$e(L)}function W(L){let T=L.textures;for(let Z=0,ve=T.length;Z<ve;Z++){let de=T[Z];if(O(de)&&de.mipmapsAutoUpdate===!0){let pe=U(L),Me=n.get(de).__webglTexture;t.bindTexture(pe,Me),I(pe),t.unbindTexture()}}}let pn=[];function At(L){if(L.samples>0){if(Le(L)===!1){let T=L.textures,Z=L.width,ve=L.height,de=i.COLOR_BUFFER_BIT,pe=L.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,Me=n.get(L),ae=T.length>1;if(ae)for(let Re=0;Re<T.length;Re++)t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+Re,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+Re,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,Me.__webglMultisampledFramebuffer),L.texture.mipmaps.length>0?t.bindFramebuffer(i.DRAW_FRAMEBUFFER,Me.__webglFramebuffer[0]):t.bindFramebuffer(i.DRAW_FRAMEBUFFER,Me.__webglFramebuffer);for(let Re=0;Re<T.length;Re++){if(L.resolveDepthBuffer&&(L.depthBuffer&&(de|=i.DEPTH_BUFFER_BIT),L.stencilBuffer&&L.resolveStencilBuffer&&(de|=i.STENCIL_BUFFER_BIT)),ae){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,Me.__webglColorRenderbuffer[Re]);let B=n.get(T[Re]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,B,0)}i.blitFramebuffer(0,0,Z,ve,0,0,Z,ve,de,i.NEAREST),f===!0&&(pn.length=0,pn.push(i.COLOR_ATTACHMENT0+Re),L.depthBuffer&&L.storeMultisampledDepthBuffer===!1&&pn.push(pe),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,pn))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),ae)for(let Re=0;Re<T.length;Re++){t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+Re,i.RENDERBUFFER,Me.__webglColorRenderbuffer[Re]);let B=n.get(T[Re]).__webglTexture;t.bindFramebuffer(i.FRAMEBUFFER,Me.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+Re,i.TEXTURE_2D,B,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,Me.__webglMultisampledFramebuffer)}else if(L.depthBuffer&&L.storeMultisampledDepthBuffer===!1&&f){let T=L.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[T])}}}function Ft(L){return Math.min(s.maxSamples,L.samples)}function Le(L){let T=n.get(L);return L.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&T.__useRenderToTexture!==!1}function Wt(L){let T=c.render.frame;m.get(L)!==T&&(m.set(L,T),L.update())}function je(L,T){let Z=L.colorSpace,ve=L.format,de=L.type;return L.isCompressedTexture===!0||L.isVideoTexture===!0||Z!==ls&&Z!==Ei&&(yt.getTransfer(Z)===Rt?(ve!==qn||de!==bn)&&Qe("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):tt("WebGLTextures: Unsupported texture color space:",Z)),T}function Ze(L){return typeof HTMLImageElement<"u"&&L instanceof HTMLImageElement?(d.width=L.naturalWidth||L.width,d.height=L.naturalHeight||L.height):typeof VideoFrame<"u"&&L instanceof VideoFrame?(d.width=L.displayWidth,d.height=L.displayHeight):(d.width=L.width,d.height=L.height),d}this.allocateTextureUnit=nt,this.resetTextureUnits=H,this.getTextureUnits=me,this.setTextureUnits=We,this.setTexture2D=Fe,this.setTexture2DArray=Pe,this.setTexture3D=Ye,this.setTextureCube=Ue,this.rebindTextures=an,this.setupRenderTarget=en,this.updateRenderTargetMipmap=W,this.updateMultisampleRenderTarget=At,this.setupDepthRenderbuffer=$e,this.setupFrameBufferTexture=xt,this.useMultisampledRTT=Le,this.dispose=ie}function LM(i,e){function t(n,s=Ei){let o,c=yt.getTransfer(s);if(n===bn)return i.UNSIGNED_BYTE;if(n===_o)return i.UNSIGNED_SHORT_4_4_4_4;if(n===vo)return i.UNSIGNED_SHORT_5_5_5_1;if(n===vc)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===yc)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===gc)return i.BYTE;if(n===_c)return i.SHORT;if(n===Hr)return i.UNSIGNED_SHORT;if(n===go)return i.INT;if(n===Wn)return i.UNSIGNED_INT;if(n===Xn)return i.FLOAT;if(n===$n)return i.HALF_FLOAT;if(n===xc)return i.ALPHA;if(n===Sc)return i.RGB;if(n===qn)return i.RGBA;if(n===xi)return i.DEPTH_COMPONENT;if(n===bi)return i.DEPTH_STENCIL;if(n===Mc)return i.RED;if(n===yo)return i.RED_INTEGER;if(n===Vi)return i.RG;if(n===xo)return i.RG_INTEGER;if(n===So)return i.RGBA_INTEGER;if(n===Us||n===Os||n===Bs||n===ks)if(c===Rt)if(o=e.get("WEBGL_compressed_texture_s3tc_srgb"),o!==null){if(n===Us)return o.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===Os)return o.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===Bs)return o.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===ks)return o.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(o=e.get("WEBGL_compressed_texture_s3tc"),o!==null){if(n===Us)return o.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===Os)return o.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===Bs)return o.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===ks)return o.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===Mo||n===bo||n===Eo||n===wo)if(o=e.get("WEBGL_compressed_texture_pvrtc"),o!==null){if(n===Mo)return o.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===bo)return o.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Eo)return o.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===wo)return o.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===To||n===Ao||n===Ro||n===Co||n===Po||n===zs||n===Io)if(o=e.get("WEBGL_compressed_texture_etc"),o!==null){if(n===To||n===Ao)return c===Rt?o.COMPRESSED_SRGB8_ETC2:o.COMPRESSED_RGB8_ETC2;if(n===Ro)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:o.COMPRESSED_RGBA8_ETC2_EAC;if(n===Co)return o.COMPRESSED_R11_EAC;if(n===Po)return o.COMPRESSED_SIGNED_R11_EAC;if(n===zs)return o.COMPRESSED_RG11_EAC;if(n===Io)return o.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===Do||n===Lo||n===Fo||n===No||n===Uo||n===Oo||n===Bo||n===ko||n===zo||n===Go||n===Vo||n===Ho||n===Wo||n===Xo)if(o=e.get("WEBGL_compressed_texture_astc"),o!==null){if(n===Do)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:o.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Lo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:o.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===Fo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:o.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===No)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:o.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===Uo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:o.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Oo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:o.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Bo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:o.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===ko)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:o.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===zo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:o.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===Go)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:o.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===Vo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:o.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===Ho)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:o.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===Wo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:o.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Xo)return c===Rt?o.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:o.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===$o||n===qo||n===Yo)if(o=e.get("EXT_texture_compression_bptc"),o!==null){if(n===$o)return c===Rt?o.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:o.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===qo)return o.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Yo)return o.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===jo||n===Zo||n===Gs||n===Jo)if(o=e.get("EXT_texture_compression_rgtc"),o!==null){if(n===jo)return o.COMPRESSED_RED_RGTC1_EXT;if(n===Zo)return o.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===Gs)return o.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===Jo)return o.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===ar?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}var FM=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,NM=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Wc=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new ys(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new oi({vertexShader:FM,fragmentShader:NM,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Mn(new bs(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Xc=class extends Vn{constructor(e,t){super();let n=this,s=null,o=1,c=null,u="local-floor",f=1,d=null,m=null,y=null,g=null,S=null,E=null,C=typeof XRWebGLBinding<"u",x=new Wc,v={},P=t.getContextAttributes(),O=null,I=null,U=[],N=[],b=new et,D=null,q=null,k=new _n;k.viewport=new zt;let Y=new _n;Y.viewport=new zt;let J=[k,Y],ee=new uo,z=null,ie=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(ue){let Fe=U[ue];return Fe===void 0&&(Fe=new Lr,U[ue]=Fe),Fe.getTargetRaySpace()},this.getControllerGrip=function(ue){let Fe=U[ue];return Fe===void 0&&(Fe=new Lr,U[ue]=Fe),Fe.getGripSpace()},this.getHand=function(ue){let Fe=U[ue];return Fe===void 0&&(Fe=new Lr,U[ue]=Fe),Fe.getHandSpace()};function G(ue){let Fe=N.indexOf(ue.inputSource);if(Fe===-1)return;let Pe=U[Fe];Pe!==void 0&&(Pe.update(ue.inputSource,ue.frame,d||c),Pe.dispatchEvent({type:ue.type,data:ue.inputSource}))}function ne(){s.removeEventListener("select",G),s.removeEventListener("selectstart",G),s.removeEventListener("selectend",G),s.removeEventListener("squeeze",G),s.removeEventListener("squeezestart",G),s.removeEventListener("squeezeend",G),s.removeEventListener("end",ne),s.removeEventListener("inputsourceschange",Se);for(let ue=0;ue<U.length;ue++){let Fe=N[ue];Fe!==null&&(N[ue]=null,U[ue].disconnect(Fe))}z=null,ie=null,x.reset();for(let ue in v)delete v[ue];if(e.setRenderTarget(O),S=null,g=null,y=null,s=null,I=null,nt.stop(),n.isPresenting=!1,e.setPixelRatio(D),e.setSize(b.width,b.height,!1),q!==null){let ue=q.camera;ue.fov=q.fov,ue.zoom=q.zoom,ue.updateProjectionMatrix(),q=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(ue){o=ue,n.isPresenting===!0&&Qe("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(ue){u=ue,n.isPresenting===!0&&Qe("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return d||c},this.setReferenceSpace=function(ue){d=ue},this.getBaseLayer=function(){return g!==null?g:S},this.getBinding=function(){return y===null&&C&&(y=new XRWebGLBinding(s,t)),y},this.getFrame=function(){return E},this.getSession=function(){return s},this.setSession=async function(ue){if(s=ue,s!==null){if(O=e.getRenderTarget(),s.addEventListener("select",G),s.addEventListener("selectstart",G),s.addEventListener("selectend",G),s.addEventListener("squeeze",G),s.addEventListener("squeezestart",G),s.addEventListener("squeezeend",G),s.addEventListener("end",ne),s.addEventListener("inputsourceschange",Se),P.xrCompatible!==!0&&await t.makeXRCompatible(),D=e.getPixelRatio(),e.getSize(b),C&&"createProjectionLayer"in XRWebGLBinding.prototype){let Pe=null,Ye=null,Ue=null;P.depth&&(Ue=P.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,Pe=P.stencil?bi:xi,Ye=P.stencil?ar:Wn);let rt={colorFormat:t.RGBA8,depthFormat:Ue,scaleFactor:o};y=this.getBinding(),g=y.createProjectionLayer(rt),s.updateRenderState({layers:[g]}),e.setPixelRatio(1),e.setSize(g.textureWidth,g.textureHeight,!1),I=new Cn(g.textureWidth,g.textureHeight,{format:qn,type:bn,depthTexture:new Mi(g.textureWidth,g.textureHeight,Ye,void 0,void 0,void 0,void 0,void 0,void 0,Pe),stencilBuffer:P.stencil,colorSpace:e.outputColorSpace,samples:P.antialias?4:0,resolveDepthBuffer:g.ignoreDepthValues===!1,resolveStencilBuffer:g.ignoreDepthValues===!1,storeMultisampledDepthBuffer:g.ignoreDepthValues===!1,storeMultisampledStencilBuffer:g.ignoreDepthValues===!1})}else{let Pe={antialias:P.antialias,alpha:!0,depth:P.depth,stencil:P.stencil,framebufferScaleFactor:o};S=new XRWebGLLayer(s,t,Pe),s.updateRenderState({baseLayer:S}),e.setPixelRatio(1),e.setSize(S.framebufferWidth,S.framebufferHeight,!1),I=new Cn(S.framebufferWidth,S.framebufferHeight,{format:qn,type:bn,colorSpace:e.outputColorSpace,stencilBuffer:P.stencil,resolveDepthBuffer:S.ignoreDepthValues===!1,resolveStencilBuffer:S.ignoreDepthValues===!1,storeMultisampledDepthBuffer:S.ignoreDepthValues===!1,storeMultisampledStencilBuffer:S.ignoreDepthValues===!1})}I.isXRRenderTarget=!0,this.setFoveation(f),d=null,c=await s.requestReferenceSpace(u),nt.setContext(s),nt.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return x.getDepthTexture()};function Se(ue){for(let Fe=0;Fe<ue.removed.length;Fe++){let Pe=ue.removed[Fe],Ye=N.indexOf(Pe);Ye>=0&&(N[Ye]=null,U[Ye].disconnect(Pe))}for(let Fe=0;Fe<ue.added.length;Fe++){let Pe=ue.added[Fe],Ye=N.indexOf(Pe);if(Ye===-1){for(let rt=0;rt<U.length;rt++)if(rt>=N.length){N.push(Pe),Ye=rt;break}else if(N[rt]===null){N[rt]=Pe,Ye=rt;break}if(Ye===-1)break}let Ue=U[Ye];Ue&&Ue.connect(Pe)}}function re(ue,Fe){Fe===null?ue.matrixWorld.copy(ue.matrix):ue.matrixWorld.multiplyMatrices(Fe.matrixWorld,ue.matrix),ue.matrixWorldInverse.copy(ue.matrixWorld).invert()}this.updateCamera=function(ue){if(s===null)return;let Fe=ue.near,Pe=ue.far;x.texture!==null&&(x.depthNear>0&&(Fe=x.depthNear),x.depthFar>0&&(Pe=x.depthFar)),ee.near=Y.near=k.near=Fe,ee.far=Y.far=k.far=Pe,(z!==ee.near||ie!==ee.far)&&(s.updateRenderState({depthNear:ee.near,depthFar:ee.far}),z=ee.near,ie=ee.far),ee.layers.mask=ue.layers.mask|6,k.layers.mask=ee.layers.mask&-5,Y.layers.mask=ee.layers.mask&-3;let Ye=ue.parent,Ue=ee.cameras;re(ee,Ye);for(let rt=0;rt<Ue.length;rt++)re(Ue[rt],Ye);ee.projectionMatrix.copy(k.projectionMatrix),ee.projectionMatrixInverse.copy(k.projectionMatrixInverse),q===null&&ue.isPerspectiveCamera&&(q={camera:ue,fov:ue.fov,zoom:ue.zoom}),H(ue,ee,Ye)};function H(ue,Fe,Pe){Pe===null?ue.matrix.copy(Fe.matrixWorld):(ue.matrix.copy(Pe.matrixWorld),ue.matrix.invert(),ue.matrix.multiply(Fe.matrixWorld)),ue.matrix.decompose(ue.position,ue.quaternion,ue.scale),ue.updateMatrixWorld(!0),ue.projectionMatrix.copy(Fe.projectionMatrix),ue.projectionMatrixInverse.copy(Fe.projectionMatrixInverse),ue.isPerspectiveCamera&&(ue.fov=Pr*2*Math.atan(1/ue.projectionMatrix.elements[5]),ue.zoom=1)}this.getCamera=function(){return ee},this.getFoveation=function(){if(!(g===null&&S===null))return f},this.setFoveation=function(ue){f=ue,g!==null&&(g.fixedFoveation=ue),S!==null&&S.fixedFoveation!==void 0&&(S.fixedFoveation=ue)},this.hasDepthSensing=function(){return x.texture!==null},this.getDepthSensingMesh=function(){return x.getMesh(ee)},this.getCameraTexture=function(ue){return v[ue]};let me=null;function We(ue,Fe){if(m=Fe.getViewerPose(d||c),E=Fe,m!==null){let Pe=m.views;S!==null&&(e.setRenderTargetFramebuffer(I,S.framebuffer),e.setRenderTarget(I));let Ye=!1;Pe.length!==ee.cameras.length&&(ee.cameras.length=0,Ye=!0);for(let Ke=0;Ke<Pe.length;Ke++){let bt=Pe[Ke],Tt=null;if(S!==null)Tt=S.getViewport(bt);else{let Vt=y.getViewSubImage(g,bt);Tt=Vt.viewport,Ke===0&&(e.setRenderTargetTextures(I,Vt.colorTexture,Vt.depthStencilTexture),e.setRenderTarget(I))}let dt=J[Ke];dt===void 0&&(dt=new _n,dt.layers.enable(Ke),dt.viewport=new zt,J[Ke]=dt),dt.matrix.fromArray(bt.transform.matrix),dt.matrix.decompose(dt.position,dt.quaternion,dt.scale),dt.projectionMatrix.fromArray(bt.projectionMatrix),dt.projectionMatrixInverse.copy(dt.projectionMatrix).invert(),dt.viewport.set(Tt.x,Tt.y,Tt.width,Tt.height),Ke===0&&(ee.matrix.copy(dt.matrix),ee.matrix.decompose(ee.position,ee.quaternion,ee.scale)),Ye===!0&&ee.cameras.push(dt)}let Ue=s.enabledFeatures;if(Ue&&Ue.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&C){y=n.getBinding();let Ke=y.getDepthInformation(Pe[0]);Ke&&Ke.isValid&&Ke.texture&&x.init(Ke,s.renderState)}if(Ue&&Ue.includes("camera-access")&&C){e.state.unbindTexture(),y=n.getBinding();for(let Ke=0;Ke<Pe.length;Ke++){let bt=Pe[Ke].camera;if(bt){let Tt=v[bt];Tt||(Tt=new ys,v[bt]=Tt);let dt=y.getCameraImage(bt);Tt.sourceTexture=dt}}}}for(let Pe=0;Pe<U.length;Pe++){let Ye=N[Pe],Ue=U[Pe];Ye!==null&&Ue!==void 0&&Ue.update(Ye,Fe,d||c)}me&&me(ue,Fe),Fe.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:Fe}),E=null}let nt=new wd;nt.setAnimationLoop(We),this.setAnimationLoop=function(ue){me=ue},this.dispose=function(){}}},UM=new Lt,Nd=new at;Nd.set(-1,0,0,0,1,0,0,0,1);function OM(i,e){function t(x,v){x.matrixAutoUpdate===!0&&x.updateMatrix(),v.value.copy(x.matrix)}function n(x,v){v.color.getRGB(x.fogColor.value,Dc(i)),v.isFog?(x.fogNear.value=v.near,x.fogFar.value=v.far):v.isFogExp2&&(x.fogDensity.value=v.density)}function s(x,v,P,O,I){v.isNodeMaterial?v.uniformsNeedUpdate=!1:v.isMeshBasicMaterial?o(x,v):v.isMeshLambertMaterial?(o(x,v),v.envMap&&(x.envMapIntensity.value=v.envMapIntensity)):v.isMeshToonMaterial?(o(x,v),y(x,v)):v.isMeshPhongMaterial?(o(x,v),m(x,v),v.envMap&&(x.envMapIntensity.value=v.envMapIntensity)):v.isMeshStandardMaterial?(o(x,v),g(x,v),v.isMeshPhysicalMaterial&&S(x,v,I)):v.isMeshMatcapMaterial?(o(x,v),E(x,v)):v.isMeshDepthMaterial?o(x,v):v.isMeshDistanceMaterial?(o(x,v),C(x,v)):v.isMeshNormalMaterial?o(x,v):v.isLineBasicMaterial?(c(x,v),v.isLineDashedMaterial&&u(x,v)):v.isPointsMaterial?f(x,v,P,O):v.isSpriteMaterial?d(x,v):v.isShadowMaterial?(x.color.value.copy(v.color),x.opacity.value=v.opacity):v.isShaderMaterial&&(v.uniformsNeedUpdate=!1)}function o(x,v){x.opacity.value=v.opacity,v.color&&x.diffuse.value.copy(v.color),v.emissive&&x.emissive.value.copy(v.emissive).multiplyScalar(v.emissiveIntensity),v.map&&(x.map.value=v.map,t(v.map,x.mapTransform)),v.alphaMap&&(x.alphaMap.value=v.alphaMap,t(v.alphaMap,x.alphaMapTransform)),v.bumpMap&&(x.bumpMap.value=v.bumpMap,t(v.bumpMap,x.bumpMapTransform),x.bumpScale.value=v.bumpScale,v.side===xn&&(x.bumpScale.value*=-1)),v.normalMap&&(x.normalMap.value=v.normalMap,t(v.normalMap,x.normalMapTransform),x.normalScale.value.copy(v.normalScale),v.side===xn&&x.normalScale.value.negate()),v.displacementMap&&(x.displacementMap.value=v.displacementMap,t(v.displacementMap,x.displacementMapTransform),x.displacementScale.value=v.displacementScale,x.displacementBias.value=v.displacementBias),v.emissiveMap&&(x.emissiveMap.value=v.emissiveMap,t(v.emissiveMap,x.emissiveMapTransform)),v.specularMap&&(x.specularMap.value=v.specularMap,t(v.specularMap,x.specularMapTransform)),v.alphaTest>0&&(x.alphaTest.value=v.alphaTest);let P=e.get(v),O=P.envMap,I=P.envMapRotation;O&&(x.envMap.value=O,x.envMapRotation.value.setFromMatrix4(UM.makeRotationFromEuler(I)).transpose(),O.isCubeTexture&&O.isRenderTargetTexture===!1&&x.envMapRotation.value.premultiply(Nd),x.reflectivity.value=v.reflectivity,x.ior.value=v.ior,x.refractionRatio.value=v.refractionRatio),v.lightMap&&(x.lightMap.value=v.lightMap,x.lightMapIntensity.value=v.lightMapIntensity,t(v.lightMap,x.lightMapTransform)),v.aoMap&&(x.aoMap.value=v.aoMap,x.aoMapIntensity.value=v.aoMapIntensity,t(v.aoMap,x.aoMapTransform))}function c(x,v){x.diffuse.value.copy(v.color),x.opacity.value=v.opacity,v.map&&(x.map.value=v.map,t(v.map,x.mapTransform))}function u(x,v){x.dashSize.value=v.dashSize,x.totalSize.value=v.dashSize+v.gapSize,x.scale.value=v.scale}function f(x,v,P,O){x.diffuse.value.copy(v.color),x.opacity.value=v.opacity,x.size.value=v.size*P,x.scale.value=O*.5,v.map&&(x.map.value=v.map,t(v.map,x.uvTransform)),v.alphaMap&&(x.alphaMap.value=v.alphaMap,t(v.alphaMap,x.alphaMapTransform)),v.alphaTest>0&&(x.alphaTest.value=v.alphaTest)}function d(x,v){x.diffuse.value.copy(v.color),x.opacity.value=v.opacity,x.rotation.value=v.rotation,v.map&&(x.map.value=v.map,t(v.map,x.mapTransform)),v.alphaMap&&(x.alphaMap.value=v.alphaMap,t(v.alphaMap,x.alphaMapTransform)),v.alphaTest>0&&(x.alphaTest.value=v.alphaTest)}function m(x,v){x.specular.value.copy(v.specular),x.shininess.value=Math.max(v.shininess,1e-4)}function y(x,v){v.gradientMap&&(x.gradientMap.value=v.gradientMap)}function g(x,v){x.metalness.value=v.metalness,v.metalnessMap&&(x.metalnessMap.value=v.metalnessMap,t(v.metalnessMap,x.metalnessMapTransform)),x.roughness.value=v.roughness,v.roughnessMap&&(x.roughnessMap.value=v.roughnessMap,t(v.roughnessMap,x.roughnessMapTransform)),v.envMap&&(x.envMapIntensity.value=v.envMapIntensity)}function S(x,v,P){x.ior.value=v.ior,v.diffuseRoughness>0&&(x.diffuseRoughness.value=v.diffuseRoughness,v.diffuseRoughnessMap&&(x.diffuseRoughnessMap.value=v.diffuseRoughnessMap,t(v.diffuseRoughnessMap,x.diffuseRoughnessMapTransform))),v.sheen>0&&(x.sheenColor.value.copy(v.sheenColor).multiplyScalar(v.sheen),x.sheenRoughness.value=v.sheenRoughness,v.sheenColorMap&&(x.sheenColorMap.value=v.sheenColorMap,t(v.sheenColorMap,x.sheenColorMapTransform)),v.sheenRoughnessMap&&(x.sheenRoughnessMap.value=v.sheenRoughnessMap,t(v.sheenRoughnessMap,x.sheenRoughnessMapTransform))),v.clearcoat>0&&(x.clearcoat.value=v.clearcoat,x.clearcoatRoughness.value=v.clearcoatRoughness,v.clearcoatMap&&(x.clearcoatMap.value=v.clearcoatMap,t(v.clearcoatMap,x.clearcoatMapTransform)),v.clearcoatRoughnessMap&&(x.clearcoatRoughnessMap.value=v.clearcoatRoughnessMap,t(v.clearcoatRoughnessMap,x.clearcoatRoughnessMapTransform)),v.clearcoatNormalMap&&(x.clearcoatNormalMap.value=v.clearcoatNormalMap,t(v.clearcoatNormalMap,x.clearcoatNormalMapTransform),x.clearcoatNormalScale.value.copy(v.clearcoatNormalScale),v.side===xn&&x.clearcoatNormalScale.value.negate())),v.dispersion>0&&(x.dispersion.value=v.dispersion),v.retroreflectivity>0&&(x.retroreflectivity.value=v.retroreflectivity),v.iridescence>0&&(x.iridescence.value=v.iridescence,x.iridescenceIOR.value=v.iridescenceIOR,x.iridescenceThicknessMinimum.value=v.iridescenceThicknessMinimum,x.iridescenceThicknessMaximum.value=v.iridescenceThicknessMaximum,v.iridescenceMap&&(x.iridescenceMap.value=v.iridescenceMap,t(v.iridescenceMap,x.iridescenceMapTransform)),v.iridescenceThicknessMap&&(x.iridescenceThicknessMap.value=v.iridescenceThicknessMap,t(v.iridescenceThicknessMap,x.iridescenceThicknessMapTransform))),v.transmission>0&&(x.transmission.value=v.transmission,x.transmissionSamplerMap.value=P.texture,x.transmissionSamplerSize.value.set(P.width,P.height),v.transmissionMap&&(x.transmissionMap.value=v.transmissionMap,t(v.transmissionMap,x.transmissionMapTransform)),x.thickness.value=v.thickness,v.thicknessMap&&(x.thicknessMap.value=v.thicknessMap,t(v.thicknessMap,x.thicknessMapTransform)),x.attenuationDistance.value=v.attenuationDistance,x.attenuationColor.value.copy(v.attenuationColor)),v.anisotropy>0&&(x.anisotropyVector.value.set(v.anisotropy*Math.cos(v.anisotropyRotation),v.anisotropy*Math.sin(v.anisotropyRotation)),v.anisotropyMap&&(x.anisotropyMap.value=v.anisotropyMap,t(v.anisotropyMap,x.anisotropyMapTransform))),x.specularIntensity.value=v.specularIntensity,x.specularColor.value.copy(v.specularColor),v.specularColorMap&&(x.specularColorMap.value=v.specularColorMap,t(v.specularColorMap,x.specularColorMapTransform)),v.specularIntensityMap&&(x.specularIntensityMap.value=v.specularIntensityMap,t(v.specularIntensityMap,x.specularIntensityMapTransform))}function E(x,v){v.matcap&&(x.matcap.value=v.matcap)}function C(x,v){let P=e.get(v).light;x.referencePosition.value.setFromMatrixPosition(P.matrixWorld),x.nearDistance.value=P.shadow.camera.near,x.farDistance.value=P.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function BM(i,e,t,n){let s={},o={};function c(P,O){let I=O.program;n.uniformBlockBinding(P,I,s[P.id])}function u(P,O){let I=s[P.id];I===void 0&&(E(P),I=f(P),s[P.id]=I,P.addEventListener("dispose",x));let U=O.program;n.updateUBOMapping(P,U);let N=e.render.frame;o[P.id]!==N&&(d(P),o[P.id]=N)}function f(P){let O=i.createBuffer(),I=P.__size,U=P.usage;return i.bindBuffer(i.UNIFORM_BUFFER,O),i.bufferData(i.UNIFORM_BUFFER,I,U),i.bindBuffer(i.UNIFORM_BUFFER,null),O}function d(P){let O=s[P.id],I=P.uniforms,U=P.__cache;i.bindBuffer(i.UNIFORM_BUFFER,O);for(let N=0,b=I.length;N<b;N++){let D=I[N];if(Array.isArray(D))for(let q=0,k=D.length;q<k;q++)m(D[q],N,q,U);else m(D,N,0,U)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function m(P,O,I,U){if(g(P,O,I,U)===!0){let N=P.__offset,b=P.value;if(Array.isArray(b)){let D=0;for(let q=0;q<b.length;q++){let k=b[q],Y=C(k,!0);y(k,P.__data,D),D+=Y.storage/Float32Array.BYTES_PER_ELEMENT}}else y(b,P.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,N,P.__data)}}function y(P,O,I){typeof P=="number"||typeof P=="boolean"?O[I]=P:P.isMatrix3?(O[I]=P.elements[0],O[I+1]=P.elements[1],O[I+2]=P.elements[2],O[I+3]=0,O[I+4]=P.elements[3],O[I+5]=P.elements[4],O[I+6]=P.elements[5],O[I+7]=0,O[I+8]=P.elements[6],O[I+9]=P.elements[7],O[I+10]=P.elements[8],O[I+11]=0):ArrayBuffer.isView(P)?O.set(P.subarray(0,O.length-I),I):P.toArray(O,I)}function g(P,O,I,U){let N=P.value,b=O+"_"+I;if(Array.isArray(N)){U[b]===void 0&&(U[b]=[]);let D=U[b],q=!1;for(let k=0;k<N.length;k++)S(N[k],D,k)===!0&&(q=!0);return q}return S(N,U,b)}function S(P,O,I){if(O[I]===void 0)return typeof P=="number"||typeof P=="boolean"?O[I]=P:ArrayBuffer.isView(P)?O[I]=P.slice():O[I]=P.clone(),!0;{let U=O[I];if(typeof P=="number"||typeof P=="boolean"){if(U!==P)return O[I]=P,!0}else{if(ArrayBuffer.isView(P))return!0;if(U.equals(P)===!1)return U.copy(P),!0}}return!1}function E(P){let O=P.uniforms,I=0,U=16;for(let b=0,D=O.length;b<D;b++){let q=Array.isArray(O[b])?O[b]:[O[b]];for(let k=0,Y=q.length;k<Y;k++){let J=q[k],ee=Array.isArray(J.value)?J.value:[J.value],z=Array.isArray(O[b])||Array.isArray(J.value),ie=I;for(let ne=0,Se=ee.length;ne<Se;ne++){let re=ee[ne],H=C(re,z),me=I%U,We=me%H.boundary,nt=me+We;I+=We,nt!==0&&U-nt<H.storage&&(I+=U-nt),ne===0&&(ie=I),I+=H.storage}let G=J.type==="int"?Int32Array:J.type==="uint"?Uint32Array:Float32Array;J.__data=new G((I-ie)/Float32Array.BYTES_PER_ELEMENT),J.__offset=ie}}let N=I%U;return N>0&&(I+=U-N),P.__size=I,P.__cache={},this}function C(P,O){let I={boundary:0,storage:0};return typeof P=="number"||typeof P=="boolean"?(I.boundary=4,I.storage=4):P.isVector2?(I.boundary=8,I.storage=8):P.isVector3||P.isColor?(I.boundary=16,I.storage=12):P.isVector4?(I.boundary=16,I.storage=16):P.isMatrix3?(I.boundary=16,I.storage=48):P.isMatrix4?(I.boundary=16,I.storage=64):P.isTexture?Qe("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(P)?(I.boundary=16,I.storage=P.byteLength):Qe("WebGLRenderer: Unsupported uniform value type.",P),O===!0&&(I.boundary=16,I.storage=Math.ceil(I.storage/16)*16),I}function x(P){let O=P.target;O.removeEventListener("dispose",x),i.deleteBuffer(s[O.id]),delete s[O.id],delete o[O.id]}function v(){for(let P in s)i.deleteBuffer(s[P]);s={},o={}}return{bind:c,update:u,dispose:v}}var kM=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),hi=null;function zM(){return hi===null&&(hi=new Nr(kM,16,16,Vi,$n),hi.name="DFG_LUT",hi.minFilter=vn,hi.magFilter=vn,hi.wrapS=ii,hi.wrapT=ii,hi.generateMipmaps=!1,hi.needsUpdate=!0),hi}var nl=class{constructor(e={}){let{canvas:t=Yu(),context:n=null,depth:s=!0,stencil:o=!1,alpha:c=!1,antialias:u=!1,premultipliedAlpha:f=!0,preserveDrawingBuffer:d=!1,powerPreference:m="default",failIfMajorPerformanceCaveat:y=!1,reversedDepthBuffer:g=!1,outputBufferType:S=bn}=e;this.isWebGLRenderer=!0;let E;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");E=n.getContextAttributes().alpha}else E=c;let C=S,x=new Set([So,xo,yo]),v=new Set([bn,Wn,Hr,ar,_o,vo]),P=new Uint32Array(4),O=new Int32Array(4),I={textures:[],min:[],max:[],resolution:[]},U=null,N=null,b=[],D=[],q=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=ci,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let k=this,Y=!1,J=null,ee=null,z=null,ie=null;this._outputColorSpace=dn;let G=0,ne=0,Se=null,re=-1,H=null,me=new zt,We=new zt,nt=null,ue=new ct(0),Fe=0,Pe=t.width,Ye=t.height,Ue=1,rt=null,Gt=null,Ke=new zt(0,0,Pe,Ye),bt=new zt(0,0,Pe,Ye),Tt=!1,dt=new Fi,Vt=new Ya,ut=!1,Ct=!1,xt=new Lt,Qt=new j,De=new zt,$e={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},an=!1;function en(){return Se===null?Ue:1}let W=n;function pn(R,V){return t.getContext(R,V)}let At,Ft,Le,Wt,je,Ze,L,T,Z,ve,de,pe,Me,ae,le,Re,B,he,se,Ce,we,Ae,Xe;try{let R={alpha:!0,depth:s,stencil:o,antialias:u,premultipliedAlpha:f,preserveDrawingBuffer:d,powerPreference:m,failIfMajorPerformanceCaveat:y};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",qe,!1),t.addEventListener("webglcontextrestored",lt,!1),t.addEventListener("webglcontextcreationerror",Oe,!1),W===null){let V="webgl2";if(W=pn(V,R),W===null)throw pn(V)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}ot()}catch(R){throw t.removeEventListener("webglcontextlost",qe,!1),t.removeEventListener("webglcontextrestored",lt,!1),t.removeEventListener("webglcontextcreationerror",Oe,!1),tt("WebGLRenderer: "+R.message),R}function ot(){At=new Jx(W),At.init(),we=new LM(W,At),Ft=new zx(W,At,e,we),Le=new IM(W,At),Ft.reversedDepthBuffer&&g&&Le.buffers.depth.setReversed(!0),ee=W.createFramebuffer(),z=W.createFramebuffer(),ie=W.createFramebuffer(),Wt=new eS(W),je=new _M,Ze=new DM(W,At,Le,je,Ft,we,Wt),L=new Zx(k),T=new nv(W),Ae=new Bx(W,T),Z=new Kx(W,T,Wt,Ae),ve=new nS(W,Z,T,Ae,Wt),he=new tS(W,Ft,Ze),le=new Gx(je),de=new gM(k,L,At,Ft,Ae,le),pe=new OM(k,je),Me=new yM,ae=new wM(At),B=new Ox(k,L,Le,ve,E,f),Re=new PM(k,ve,Ft),Xe=new BM(W,Wt,Ft,Le),se=new kx(W,At,Wt),Ce=new Qx(W,At,Wt),Wt.programs=de.programs,k.capabilities=Ft,k.extensions=At,k.properties=je,k.renderLists=Me,k.shadowMap=Re,k.state=Le,k.info=Wt}C!==bn&&(q=new rS(C,t.width,t.height,u,s,o));let Ee=new Xc(k,W);this.xr=Ee,this.getContext=function(){return W},this.getContextAttributes=function(){return W.getContextAttributes()},this.forceContextLoss=function(){let R=At.get("WEBGL_lose_context");R&&R.loseContext()},this.forceContextRestore=function(){let R=At.get("WEBGL_lose_context");R&&R.restoreContext()},this.getPixelRatio=function(){return Ue},this.setPixelRatio=function(R){R!==void 0&&(Ue=R,this.setSize(Pe,Ye,!1))},this.getSize=function(R){return R.set(Pe,Ye)},this.setSize=function(R,V,te=!0){if(Ee.isPresenting){Qe("WebGLRenderer: Can't change size while VR device is presenting.");return}Pe=R,Ye=V,t.width=Math.floor(R*Ue),t.height=Math.floor(V*Ue),te===!0&&(t.style.width=R+"px",t.style.height=V+"px"),q!==null&&q.setSize(t.width,t.height),this.setViewport(0,0,R,V)},this.getDrawingBufferSize=function(R){return R.set(Pe*Ue,Ye*Ue).floor()},this.setDrawingBufferSize=function(R,V,te){Pe=R,Ye=V,Ue=te,t.width=Math.floor(R*te),t.height=Math.floor(V*te),this.setViewport(0,0,R,V)},this.setEffects=function(R){if(C===bn){tt("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(R){for(let V=0;V<R.length;V++)if(R[V].isOutputPass===!0){Qe("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}q.setEffects(R||[])},this.getCurrentViewport=function(R){return R.copy(me)},this.getViewport=function(R){return R.copy(Ke)},this.setViewport=function(R,V,te,K){R.isVector4?Ke.set(R.x,R.y,R.z,R.w):Ke.set(R,V,te,K),Le.viewport(me.copy(Ke).multiplyScalar(en()).round())},this.getScissor=function(R){return R.copy(bt)},this.setScissor=function(R,V,te,K){R.isVector4?bt.set(R.x,R.y,R.z,R.w):bt.set(R,V,te,K),Le.scissor(We.copy(bt).multiplyScalar(en()).round())},this.getScissorTest=function(){return Tt},this.setScissorTest=function(R){Le.setScissorTest(Tt=R)},this.setOpaqueSort=function(R){rt=R},this.setTransparentSort=function(R){Gt=R},this.getClearColor=function(R){return R.copy(B.getClearColor())},this.setClearColor=function(){B.setClearColor(...arguments)},this.getClearAlpha=function(){return B.getClearAlpha()},this.setClearAlpha=function(){B.setClearAlpha(...arguments)},this.clear=function(R=!0,V=!0,te=!0){let K=0;if(R){let $=!1;if(Se!==null){let Ie=Se.texture.format;$=x.has(Ie)}if($){let Ie=Se.texture.type,ze=v.has(Ie),Te=B.getClearColor(),Ne=B.getClearAlpha(),Ge=Te.r,it=Te.g,ft=Te.b;ze?(P[0]=Ge,P[1]=it,P[2]=ft,P[3]=Ne,W.clearBufferuiv(W.COLOR,0,P)):(O[0]=Ge,O[1]=it,O[2]=ft,O[3]=Ne,W.clearBufferiv(W.COLOR,0,O))}else K|=W.COLOR_BUFFER_BIT}V&&(K|=W.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),te&&(K|=W.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),K!==0&&W.clear(K)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(R){R.setRenderer(this),J=R},this.dispose=function(){t.removeEventListener("webglcontextlost",qe,!1),t.removeEventListener("webglcontextrestored",lt,!1),t.removeEventListener("webglcontextcreationerror",Oe,!1),B.dispose(),Me.dispose(),ae.dispose(),Ze.dispose(),je.dispose(),L.dispose(),ve.dispose(),Z.dispose(),Ae.dispose(),Xe.dispose(),de.dispose(),Ee.dispose(),Ee.removeEventListener("sessionstart",qr),Ee.removeEventListener("sessionend",fi),on.stop()};function qe(R){R.preventDefault(),Ac("WebGLRenderer: Context Lost."),Y=!0}function lt(){Ac("WebGLRenderer: Context Restored."),Y=!1;let R=Wt.autoReset,V=Re.enabled,te=Re.autoUpdate,K=Re.needsUpdate,$=Re.type;ot(),Wt.autoReset=R,Re.enabled=V,Re.autoUpdate=te,Re.needsUpdate=K,Re.type=$}function Oe(R){tt("WebGLRenderer: A WebGL context could not be created. Reason: ",R.statusMessage)}function Et(R){let V=R.target;V.removeEventListener("dispose",Et),Ut(V)}function Ut(R){di(R),je.remove(R)}function di(R){let V=je.get(R).programs;V!==void 0&&(V.forEach(function(te){de.releaseProgram(te)}),R.isShaderMaterial&&de.releaseShaderCache(R))}this.renderBufferDirect=function(R,V,te,K,$,Ie){V===null&&(V=$e);let ze=$.isMesh&&$.matrixWorld.determinantAffine()<0,Te=ll(R,V,te,K,$);Le.setMaterial(K,ze);let Ne=te.index,Ge=1;if(K.wireframe===!0){if(Ne=Z.getWireframeAttribute(te),Ne===void 0)return;Ge=2}let it=te.drawRange,ft=te.attributes.position,Ve=it.start*Ge,st=(it.start+it.count)*Ge;Ie!==null&&(Ve=Math.max(Ve,Ie.start*Ge),st=Math.min(st,(Ie.start+Ie.count)*Ge)),Ne!==null?(Ve=Math.max(Ve,0),st=Math.min(st,Ne.count)):ft!=null&&(Ve=Math.max(Ve,0),st=Math.min(st,ft.count));let Ht=st-Ve;if(Ht<0||Ht===1/0)return;Ae.setup($,K,Te,te,Ne);let ke,Pt=se;if(Ne!==null&&(ke=T.get(Ne),Pt=Ce,Pt.setIndex(ke)),$.isMesh)K.wireframe===!0?(Le.setLineWidth(K.wireframeLinewidth*en()),Pt.setMode(W.LINES)):Pt.setMode(W.TRIANGLES);else if($.isLine){let $t=K.linewidth;$t===void 0&&($t=1),Le.setLineWidth($t*en()),$.isLineSegments?Pt.setMode(W.LINES):$.isLineLoop?Pt.setMode(W.LINE_LOOP):Pt.setMode(W.LINE_STRIP)}else $.isPoints?Pt.setMode(W.POINTS):$.isSprite&&Pt.setMode(W.TRIANGLES);if($.isBatchedMesh)if(At.get("WEBGL_multi_draw"))Pt.renderMultiDraw($._multiDrawStarts,$._multiDrawCounts,$._multiDrawCount);else{let $t=$._multiDrawStarts,He=$._multiDrawCounts,tn=$._multiDrawCount,St=Ne?T.get(Ne).bytesPerElement:1,Zn=je.get(K).currentProgram.getUniforms();for(let nn=0;nn<tn;nn++)Zn.setValue(W,"_gl_DrawID",nn),Pt.render($t[nn]/St,He[nn])}else if($.isInstancedMesh)Pt.renderInstances(Ve,Ht,$.count);else if(te.isInstancedBufferGeometry){let $t=te._maxInstanceCount!==void 0?te._maxInstanceCount:1/0,He=Math.min(te.instanceCount,$t);Pt.renderInstances(Ve,Ht,He)}else Pt.render(Ve,Ht)};function ye(R,V,te,K){J!==null&&R.isNodeMaterial&&J.setObject(K,R),ut===!0&&le.setState(R,te,!1),R.transparent===!0&&R.side===li&&R.forceSinglePass===!1?(R.side=xn,R.needsUpdate=!0,Wi(R,V,K),R.side=Gi,R.needsUpdate=!0,Wi(R,V,K),R.side=li):Wi(R,V,K)}this.compile=function(R,V,te=null){te===null&&(te=R),J!==null&&J.renderStart(R,V,te),N=ae.get(te),N.init(V),D.push(N),te.traverseVisible(function($){$.isLight&&$.layers.test(V.layers)&&(N.pushLight($),$.castShadow&&N.pushShadow($))}),R!==te&&R.traverseVisible(function($){$.isLight&&$.layers.test(V.layers)&&(N.pushLight($),$.castShadow&&N.pushShadow($))}),N.setupLights(),J!==null&&J.updateLights(N.state.lightsArray),Ct=this.localClippingEnabled,ut=le.init(this.clippingPlanes,Ct),ut===!0&&le.setGlobalState(this.clippingPlanes,V),J!==null&&Re.render(N.state.shadowsArray,te,V);let K=new Set;return R.traverse(function($){if(!($.isMesh||$.isPoints||$.isLine||$.isSprite))return;let Ie=$.material;if(Ie)if(Array.isArray(Ie))for(let ze=0;ze<Ie.length;ze++){let Te=Ie[ze];ye(Te,te,V,$),K.add(Te)}else ye(Ie,te,V,$),K.add(Ie)}),N=D.pop(),J!==null&&J.renderEnd(),K},this.compileAsync=function(R,V,te=null){let K=this.compile(R,V,te);return new Promise($=>{function Ie(){if(K.forEach(function(ze){let Ne=je.get(ze).currentProgram;(Ne===void 0||Ne.isReady())&&K.delete(ze)}),K.size===0){$(R);return}setTimeout(Ie,10)}At.get("KHR_parallel_shader_compile")!==null?Ie():setTimeout(Ie,10)})};let ge=null;function jn(R){ge&&ge(R)}function qr(){on.stop()}function fi(){on.start()}let on=new wd;on.setAnimationLoop(jn),typeof self<"u"&&on.setContext(self),this.setAnimationLoop=function(R){ge=R,Ee.setAnimationLoop(R),R===null?on.stop():on.start()},Ee.addEventListener("sessionstart",qr),Ee.addEventListener("sessionend",fi),this.render=function(R,V){if(V!==void 0&&V.isCamera!==!0){tt("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(Y===!0)return;J!==null&&J.renderStart(R,V);let te=Ee.enabled===!0&&Ee.isPresenting===!0,K=q!==null&&(Se===null||te)&&q.begin(k,Se);if(R.matrixWorldAutoUpdate===!0&&R.updateMatrixWorld(),V.parent===null&&V.matrixWorldAutoUpdate===!0&&V.updateMatrixWorld(),Ee.enabled===!0&&Ee.isPresenting===!0&&(q===null||q.isCompositing()===!1)&&(Ee.cameraAutoUpdate===!0&&Ee.updateCamera(V),V=Ee.getCamera()),R.isScene===!0&&R.onBeforeRender(k,R,V,Se),N=ae.get(R,D.length),N.init(V),N.state.textureUnits=Ze.getTextureUnits(),D.push(N),xt.multiplyMatrices(V.projectionMatrix,V.matrixWorldInverse),V.isArrayCamera?Vt.setFromArrayCamera(V):dt.setFromProjectionMatrix(xt,Nn,V.reversedDepth),Ct=this.localClippingEnabled,ut=le.init(this.clippingPlanes,Ct),U=Me.get(R,b.length),U.init(),b.push(U),this.info.render.frame++,Ee.enabled===!0&&Ee.isPresenting===!0){let ze=k.xr.getDepthSensingMesh();ze!==null&&Yr(ze,V,-1/0,k.sortObjects)}Yr(R,V,0,k.sortObjects),U.finish(),J!==null&&J.updateLights(N.state.lightsArray),k.sortObjects===!0&&U.sort(rt,Gt),an=Ee.enabled===!1||Ee.isPresenting===!1||Ee.hasDepthSensing()===!1,an&&B.addToRenderList(U,R),this.info.autoReset===!0&&this.info.reset(),ut===!0&&le.beginShadows();let $=N.state.shadowsArray;if(Re.render($,R,V),ut===!0&&le.endShadows(),(K&&q.hasRenderPass())===!1){let ze=U.opaque,Te=U.transmissive;if(N.setupLights(),V.isArrayCamera){let Ne=V.cameras;if(Te.length>0)for(let Ge=0,it=Ne.length;Ge<it;Ge++){let ft=Ne[Ge];Hi(ze,Te,R,ft)}an&&B.render(R);for(let Ge=0,it=Ne.length;Ge<it;Ge++){let ft=Ne[Ge];In(U,R,ft,ft.viewport)}}else Te.length>0&&Hi(ze,Te,R,V),an&&B.render(R),In(U,R,V)}Se!==null&&ne===0&&(Ze.updateMultisampleRenderTarget(Se),Ze.updateRenderTargetMipmap(Se)),K&&q.end(k),R.isScene===!0&&R.onAfterRender(k,R,V),Ae.resetDefaultState(),re=-1,H=null,D.pop(),D.length>0?(N=D[D.length-1],Ze.setTextureUnits(N.state.textureUnits),ut===!0&&le.setGlobalState(k.clippingPlanes,N.state.camera)):N=null,b.pop(),b.length>0?U=b[b.length-1]:U=null,J!==null&&J.renderEnd()};function Yr(R,V,te,K){if(R.visible===!1)return;if(R.layers.test(V.layers)){if(R.isGroup)te=R.renderOrder;else if(R.isLOD)R.autoUpdate===!0&&R.update(V);else if(R.isLight)N.pushLight(R),R.castShadow&&N.pushShadow(R);else if(R.isSprite){let ze=V.isArrayCamera?Vt:dt;if(!R.frustumCulled||R.intersectsFrustum(ze)){K&&De.setFromMatrixPosition(R.matrixWorld).applyMatrix4(xt);let Te=ve.update(R),Ne=R.material;Ne.visible&&U.push(R,Te,Ne,te,De.z,null,V)}}else if(R.isMesh||R.isLine||R.isPoints){let ze=V.isArrayCamera?Vt:dt;if(!R.frustumCulled||R.intersectsFrustum(ze)){let Te=ve.update(R),Ne=R.material;if(K&&(R.boundingSphere!==void 0?(R.boundingSphere===null&&R.computeBoundingSphere(),De.copy(R.boundingSphere.center)):(Te.boundingSphere===null&&Te.computeBoundingSphere(),De.copy(Te.boundingSphere.center)),De.applyMatrix4(R.matrixWorld).applyMatrix4(xt)),Array.isArray(Ne)){let Ge=Te.groups;for(let it=0,ft=Ge.length;it<ft;it++){let Ve=Ge[it],st=Ne[Ve.materialIndex];st&&st.visible&&U.push(R,Te,st,te,De.z,Ve,V)}}else Ne.visible&&U.push(R,Te,Ne,te,De.z,null,V)}}}let Ie=R.children;for(let ze=0,Te=Ie.length;ze<Te;ze++)Yr(Ie[ze],V,te,K)}function In(R,V,te,K){let{opaque:$,transmissive:Ie,transparent:ze}=R;N.setupLightsView(te),ut===!0&&le.setGlobalState(k.clippingPlanes,te),K&&Le.viewport(me.copy(K)),$.length>0&&lr($,V,te),Ie.length>0&&lr(Ie,V,te),ze.length>0&&lr(ze,V,te),Le.buffers.depth.setTest(!0),Le.buffers.depth.setMask(!0),Le.buffers.color.setMask(!0),Le.setPolygonOffset(!1)}function Hi(R,V,te,K){if((te.isScene===!0?te.overrideMaterial:null)!==null)return;if(N.state.transmissionRenderTarget[K.id]===void 0){let Ve=At.has("EXT_color_buffer_half_float")||At.has("EXT_color_buffer_float");N.state.transmissionRenderTarget[K.id]=new Cn(1,1,{generateMipmaps:!0,type:Ve?$n:bn,minFilter:Hn,samples:Math.max(4,Ft.samples),stencilBuffer:o,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:yt.workingColorSpace})}let Ie=N.state.transmissionRenderTarget[K.id],ze=K.viewport||me;Ie.setSize(ze.z*k.transmissionResolutionScale,ze.w*k.transmissionResolutionScale);let Te=k.getRenderTarget(),Ne=k.getActiveCubeFace(),Ge=k.getActiveMipmapLevel();k.setRenderTarget(Ie),k.getClearColor(ue),Fe=k.getClearAlpha(),Fe<1&&k.setClearColor(16777215,.5),k.clear(),an&&B.render(te);let it=k.toneMapping;k.toneMapping=ci;let ft=K.viewport;if(K.viewport!==void 0&&(K.viewport=void 0),N.setupLightsView(K),ut===!0&&le.setGlobalState(k.clippingPlanes,K),lr(R,te,K),Ze.updateMultisampleRenderTarget(Ie),Ze.updateRenderTargetMipmap(Ie),At.has("WEBGL_multisampled_render_to_texture")===!1){let Ve=!1;for(let st=0,Ht=V.length;st<Ht;st++){let ke=V[st],{object:Pt,geometry:$t,material:He,group:tn}=ke;if(He.side===li&&Pt.layers.test(K.layers)){let St=He.side;He.side=xn,He.needsUpdate=!0,qs(Pt,te,K,$t,He,tn),He.side=St,He.needsUpdate=!0,Ve=!0}}Ve===!0&&(Ze.updateMultisampleRenderTarget(Ie),Ze.updateRenderTargetMipmap(Ie))}k.setRenderTarget(Te,Ne,Ge),k.setClearColor(ue,Fe),ft!==void 0&&(K.viewport=ft),k.toneMapping=it}function lr(R,V,te){let K=V.isScene===!0?V.overrideMaterial:null;for(let $=0,Ie=R.length;$<Ie;$++){let ze=R[$],{object:Te,geometry:Ne,group:Ge}=ze,it=ze.material;it.allowOverride===!0&&K!==null&&(it=K),Te.layers.test(te.layers)&&qs(Te,V,te,Ne,it,Ge)}}function qs(R,V,te,K,$,Ie){J!==null&&$.isNodeMaterial&&J.setObject(R,$),R.onBeforeRender(k,V,te,K,$,Ie),R.modelViewMatrix.multiplyMatrices(te.matrixWorldInverse,R.matrixWorld),R.normalMatrix.getNormalMatrix(R.modelViewMatrix),$.onBeforeRender(k,V,te,K,R,Ie),$.transparent===!0&&$.side===li&&$.forceSinglePass===!1?($.side=xn,$.needsUpdate=!0,k.renderBufferDirect(te,V,K,$,R,Ie),$.side=Gi,$.needsUpdate=!0,k.renderBufferDirect(te,V,K,$,R,Ie),$.side=li):k.renderBufferDirect(te,V,K,$,R,Ie),R.onAfterRender(k,V,te,K,$,Ie)}function Dn(R){let V=0;for(let te of R)te.texture!==null&&V++;return V}function Wi(R,V,te){V.isScene!==!0&&(V=$e);let K=je.get(R),$=N.state.lights,Ie=N.state.shadowsArray,ze=$.state.version,Te=de.getParameters(R,$.state,Ie,V,te,N.state.lightProbeGridArray),Ne=de.getProgramCacheKey(Te),Ge=K.programs;K.environment=R.isMeshStandardMaterial||R.isMeshLambertMaterial||R.isMeshPhongMaterial?V.environment:null,K.fog=V.fog;let it=R.isMeshStandardMaterial||R.isMeshLambertMaterial&&!R.envMap||R.isMeshPhongMaterial&&!R.envMap;K.envMap=L.get(R.envMap||K.environment,it),K.envMapRotation=K.environment!==null&&R.envMap===null?V.environmentRotation:R.envMapRotation,Ge===void 0&&(R.addEventListener("dispose",Et),Ge=new Map,K.programs=Ge,K.programVariants=new Map);let ft=Ge.get(Ne);if(ft!==void 0){if(K.currentProgram===ft&&K.lightsStateVersion===ze)return hr(R,Te),ft}else Te.uniforms=de.getUniforms(R),J!==null&&R.isNodeMaterial&&J.build(R,te,Te),R.onBeforeCompile(Te,k),ft=de.acquireProgram(Te,Ne),Ge.set(Ne,ft),K.uniforms=Te.uniforms;let Ve=K.uniforms;return(!R.isShaderMaterial&&!R.isRawShaderMaterial||R.clipping===!0)&&(Ve.clippingPlanes=le.uniform),hr(R,Te),K.needsLights=hl(R),K.lightsStateVersion=ze,K.needsLights&&(Ve.ambientLightColor.value=$.state.ambient,Ve.lightProbe.value=$.state.probe,Ve.sunLights.value=$.state.sun,Ve.sunLightShadows.value=$.state.sunShadow,Ve.directionalLights.value=$.state.directional,Ve.directionalLightShadows.value=$.state.directionalShadow,Ve.spotLights.value=$.state.spot,Ve.spotLightShadows.value=$.state.spotShadow,Ve.rectAreaLights.value=$.state.rectArea,Ve.ltc_1.value=$.state.rectAreaLTC1,Ve.ltc_2.value=$.state.rectAreaLTC2,Ve.pointLights.value=$.state.point,Ve.pointLightShadows.value=$.state.pointShadow,Ve.hemisphereLights.value=$.state.hemi,Ve.sunShadowMatrix.value=$.state.sunShadowMatrix,Ve.sunShadowCascade.value=$.state.sunShadowCascade,Ve.directionalShadowMatrix.value=$.state.directionalShadowMatrix,Ve.spotLightMatrix.value=$.state.spotLightMatrix,Ve.spotLightMap.value=$.state.spotLightMap,Ve.pointShadowMatrix.value=$.state.pointShadowMatrix),K.numLightProbeGrids=Dn(N.state.lightProbeGridArray),K.currentProgram=ft,K.uniformsList=null,ft}function cr(R,V,te,K,$){let Ie=je.get(R),ze=Ie.currentProgram.id+","+K+","+$,Te=Ie.programVariants.get(ze);return Te===void 0?(Te=Wi(R,V,te),Ie.programVariants.set(ze,Te)):(Ie.currentProgram=Te,Ie.uniformsList=null,Ie.outputColorSpace=K,Ie.toneMapping=$),Te}function Xi(R){if(R.uniformsList===null){let V=R.currentProgram.getUniforms();R.uniformsList=Xr.seqWithValue(V.seq,R.uniforms)}return R.uniformsList}function hr(R,V){let te=je.get(R);te.outputColorSpace=V.outputColorSpace,te.batching=V.batching,te.batchingColor=V.batchingColor,te.instancing=V.instancing,te.instancingColor=V.instancingColor,te.instancingMorph=V.instancingMorph,te.skinning=V.skinning,te.morphTargets=V.morphTargets,te.morphNormals=V.morphNormals,te.morphColors=V.morphColors,te.morphTargetsCount=V.morphTargetsCount,te.numClippingPlanes=V.numClippingPlanes,te.numIntersection=V.numClipIntersection,te.vertexAlphas=V.vertexAlphas,te.vertexTangents=V.vertexTangents,te.toneMapping=V.toneMapping}function ll(R,V,te,K,$){V.isScene!==!0&&(V=$e),Ze.resetTextureUnits();let Ie=V.fog,ze=K.isMeshStandardMaterial||K.isMeshLambertMaterial||K.isMeshPhongMaterial?V.environment:null,Te=Se===null?k.outputColorSpace:Se.isXRRenderTarget===!0?Se.texture.colorSpace:yt.workingColorSpace,Ne=K.isMeshStandardMaterial||K.isMeshLambertMaterial&&!K.envMap||K.isMeshPhongMaterial&&!K.envMap,Ge=L.get(K.envMap||ze,Ne),it=K.vertexColors===!0&&!!te.attributes.color&&te.attributes.color.itemSize===4,ft=!!te.attributes.tangent&&(!!K.normalMap||K.anisotropy>0),Ve=!!te.morphAttributes.position,st=!!te.morphAttributes.normal,Ht=!!te.morphAttributes.color,ke=ci;K.toneMapped&&(Se===null||Se.isXRRenderTarget===!0)&&(ke=k.toneMapping);let Pt=te.morphAttributes.position||te.morphAttributes.normal||te.morphAttributes.color,$t=Pt!==void 0?Pt.length:0,He=je.get(K),tn=N.state.lights;if(ut===!0&&(Ct===!0||R!==H)){let It=R===H&&K.id===re;le.setState(K,R,It)}let St=!1,Zn=!1;K.version===He.__version?He.needsLights&&He.lightsStateVersion!==tn.state.version||$.isBatchedMesh&&He.batching===!1||!$.isBatchedMesh&&He.batching===!0||$.isBatchedMesh&&He.batchingColor===!0&&$._colorsTexture===null||$.isBatchedMesh&&He.batchingColor===!1&&$._colorsTexture!==null||$.isInstancedMesh&&He.instancing===!1||!$.isInstancedMesh&&He.instancing===!0||$.isSkinnedMesh&&He.skinning===!1||!$.isSkinnedMesh&&He.skinning===!0||$.isInstancedMesh&&He.instancingColor===!0&&$.instanceColor===null||$.isInstancedMesh&&He.instancingColor===!1&&$.instanceColor!==null||$.isInstancedMesh&&He.instancingMorph===!0&&$.morphTexture===null||$.isInstancedMesh&&He.instancingMorph===!1&&$.morphTexture!==null||He.envMap!==Ge||K.fog===!0&&He.fog!==Ie||He.numClippingPlanes!==void 0&&(He.numClippingPlanes!==le.numPlanes||He.numIntersection!==le.numIntersection)||He.vertexAlphas!==it||He.vertexTangents!==ft||He.morphTargets!==Ve||He.morphNormals!==st||He.morphColors!==Ht||He.morphTargetsCount!==$t||He.numLightProbeGrids!==Dn(N.state.lightProbeGridArray)?St=!0:(He.outputColorSpace!==Te||He.toneMapping!==ke)&&(Zn=!0):(St=!0,He.__version=K.version);let nn=He.currentProgram;(St===!0||Zn===!0)&&(nn=Zn===!0?cr(K,V,$,Te,ke):Wi(K,V,$),J&&K.isNodeMaterial&&J.onUpdateProgram(K,nn,He));let wi=!1,Jn=!1,Kn=!1,M=nn.getUniforms(),ht=He.uniforms;if(Le.useProgram(nn.program)&&(wi=!0,Jn=!0,Kn=!0),K.id!==re&&(re=K.id,Jn=!0),wi||H!==R){Le.buffers.depth.getReversed()&&R.reversedDepth!==!0&&(R._reversedDepth=!0,R.updateProjectionMatrix()),M.setValue(W,"projectionMatrix",R.projectionMatrix),M.setValue(W,"viewMatrix",R.matrixWorldInverse);let Ot=M.map.cameraPosition;Ot!==void 0&&Ot.setValue(W,Qt.setFromMatrixPosition(R.matrixWorld)),Ft.logarithmicDepthBuffer&&M.setValue(W,"logDepthBufFC",2/(Math.log(R.far+1)/Math.LN2)),(K.isMeshPhongMaterial||K.isMeshToonMaterial||K.isMeshLambertMaterial||K.isMeshBasicMaterial||K.isMeshStandardMaterial||K.isShaderMaterial)&&M.setValue(W,"isOrthographic",R.isOrthographicCamera===!0),H!==R&&(H=R,Jn=!0,Kn=!0)}if(He.needsLights&&(tn.state.sunShadowMap.length>0&&M.setValue(W,"sunShadowMap",tn.state.sunShadowMap,Ze),tn.state.directionalShadowMap.length>0&&M.setValue(W,"directionalShadowMap",tn.state.directionalShadowMap,Ze),tn.state.spotShadowMap.length>0&&M.setValue(W,"spotShadowMap",tn.state.spotShadowMap,Ze),tn.state.pointShadowMap.length>0&&M.setValue(W,"pointShadowMap",tn.state.pointShadowMap,Ze)),$.isSkinnedMesh){M.setOptional(W,$,"bindMatrix"),M.setOptional(W,$,"bindMatrixInverse");let It=$.skeleton;It&&(It.boneTexture===null&&It.computeBoneTexture(),M.setValue(W,"boneTexture",It.boneTexture,Ze))}$.isBatchedMesh&&(M.setOptional(W,$,"batchingTexture"),M.setValue(W,"batchingTexture",$._matricesTexture,Ze),M.setOptional(W,$,"batchingIdTexture"),M.setValue(W,"batchingIdTexture",$._indirectTexture,Ze),M.setOptional(W,$,"batchingColorTexture"),$._colorsTexture!==null&&M.setValue(W,"batchingColorTexture",$._colorsTexture,Ze));let wn=te.morphAttributes;if((wn.position!==void 0||wn.normal!==void 0||wn.color!==void 0)&&he.update($,te,nn),(Jn||He.receiveShadow!==$.receiveShadow)&&(He.receiveShadow=$.receiveShadow,M.setValue(W,"receiveShadow",$.receiveShadow)),(K.isMeshStandardMaterial||K.isMeshLambertMaterial||K.isMeshPhongMaterial)&&K.envMap===null&&V.environment!==null&&(ht.envMapIntensity.value=V.environmentIntensity),ht.dfgLUT!==void 0&&(ht.dfgLUT.value=zM()),Jn){if(M.setValue(W,"toneMappingExposure",k.toneMappingExposure),He.needsLights&&cl(ht,Kn),Ie&&K.fog===!0&&pe.refreshFogUniforms(ht,Ie),pe.refreshMaterialUniforms(ht,K,Ue,Ye,N.state.transmissionRenderTarget[R.id]),He.needsLights&&He.numLightProbeGrids>0){let It=I,Ot=0;for(let Un of N.state.lightProbeGridArray)Un.texture!==null&&(It.textures[Ot]=Un.texture,It.min[Ot]=Un.boundingBox.min,It.max[Ot]=Un.boundingBox.max,It.resolution[Ot]=Un.resolution,Ot++);for(let Un in It)It[Un].length=Ot;ht.probesSH.value=It.textures,ht.probesMin.value=It.min,ht.probesMax.value=It.max,ht.probesResolution.value=It.resolution}Xr.upload(W,Xi(He),ht,Ze)}if(K.isShaderMaterial&&K.uniformsNeedUpdate===!0&&(Xr.upload(W,Xi(He),ht,Ze),K.uniformsNeedUpdate=!1),K.isSpriteMaterial&&M.setValue(W,"center",$.center),M.setValue(W,"modelViewMatrix",$.modelViewMatrix),M.setValue(W,"normalMatrix",$.normalMatrix),M.setValue(W,"modelMatrix",$.matrixWorld),K.uniformsGroups!==void 0){let It=K.uniformsGroups;for(let Ot=0,Un=It.length;Ot<Un;Ot++){let Ys=It[Ot];Xe.update(Ys,nn),Xe.bind(Ys,nn)}}return nn}function cl(R,V){R.ambientLightColor.needsUpdate=V,R.lightProbe.needsUpdate=V,R.sunLights.needsUpdate=V,R.sunLightShadows.needsUpdate=V,R.directionalLights.needsUpdate=V,R.directionalLightShadows.needsUpdate=V,R.pointLights.needsUpdate=V,R.pointLightShadows.needsUpdate=V,R.spotLights.needsUpdate=V,R.spotLightShadows.needsUpdate=V,R.rectAreaLights.needsUpdate=V,R.hemisphereLights.needsUpdate=V}function hl(R){return R.isMeshLambertMaterial||R.isMeshToonMaterial||R.isMeshPhongMaterial||R.isMeshStandardMaterial||R.isShadowMaterial||R.isShaderMaterial&&R.lights===!0}this.getActiveCubeFace=function(){return G},this.getActiveMipmapLevel=function(){return ne},this.getRenderTarget=function(){return Se},this.setRenderTargetTextures=function(R,V,te){let K=je.get(R);K.__autoAllocateDepthBuffer=R.resolveDepthBuffer===!1,K.__autoAllocateDepthBuffer===!1&&(K.__useRenderToTexture=!1),je.get(R.texture).__webglTexture=V,je.get(R.depthTexture).__webglTexture=K.__autoAllocateDepthBuffer?void 0:te,K.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(R,V){let te=je.get(R);te.__webglFramebuffer=V,te.__useDefaultFramebuffer=V===void 0},this.setRenderTarget=function(R,V=0,te=0){Se=R,G=V,ne=te;let K=null,$=!1,Ie=!1;if(R){let Te=je.get(R);if(Te.__useDefaultFramebuffer!==void 0){Le.bindFramebuffer(W.FRAMEBUFFER,Te.__webglFramebuffer),me.copy(R.viewport),We.copy(R.scissor),nt=R.scissorTest,Le.viewport(me),Le.scissor(We),Le.setScissorTest(nt),re=-1;return}else if(Te.__webglFramebuffer===void 0)Ze.setupRenderTarget(R);else if(Te.__hasExternalTextures)Ze.rebindTextures(R,je.get(R.texture).__webglTexture,je.get(R.depthTexture).__webglTexture);else if(R.depthBuffer){let it=R.depthTexture;if(Te.__boundDepthTexture!==it){if(it!==null&&je.has(it)&&(R.width!==it.image.width||R.height!==it.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Ze.setupDepthRenderbuffer(R)}}let Ne=R.texture;(Ne.isData3DTexture||Ne.isDataArrayTexture||Ne.isCompressedArrayTexture)&&(Ie=!0);let Ge=je.get(R).__webglFramebuffer;R.isWebGLCubeRenderTarget?(Array.isArray(Ge[V])?K=Ge[V][te]:K=Ge[V],$=!0):R.samples>0&&Ze.useMultisampledRTT(R)===!1?K=je.get(R).__webglMultisampledFramebuffer:Array.isArray(Ge)?K=Ge[te]:K=Ge,me.copy(R.viewport),We.copy(R.scissor),nt=R.scissorTest}else me.copy(Ke).multiplyScalar(Ue).floor(),We.copy(bt).multiplyScalar(Ue).floor(),nt=Tt;if(te!==0&&(K=ee),Le.bindFramebuffer(W.FRAMEBUFFER,K)&&Le.drawBuffers(R,K),Le.viewport(me),Le.scissor(We),Le.setScissorTest(nt),$){let Te=je.get(R.texture);W.framebufferTexture2D(W.FRAMEBUFFER,W.COLOR_ATTACHMENT0,W.TEXTURE_CUBE_MAP_POSITIVE_X+V,Te.__webglTexture,te)}else if(Ie){let Te=V;for(let Ne=0;Ne<R.textures.length;Ne++){let Ge=je.get(R.textures[Ne]);W.framebufferTextureLayer(W.FRAMEBUFFER,W.COLOR_ATTACHMENT0+Ne,Ge.__webglTexture,te,Te)}}else if(R!==null&&te!==0){let Te=je.get(R.texture);W.framebufferTexture2D(W.FRAMEBUFFER,W.COLOR_ATTACHMENT0,W.TEXTURE_2D,Te.__webglTexture,te)}re=-1};function jr(R){let V=je.get(R);return(V.__readFormat!==R.format||V.__readType!==R.type)&&(V.__readFormat=R.format,V.__readType=R.type,V.__formatReadable=Ft.textureFormatReadable(R.format),V.__typeReadable=Ft.textureTypeReadable(R.type)),V}this.readRenderTargetPixels=function(R,V,te,K,$,Ie,ze,Te=0){if(!(R&&R.isWebGLRenderTarget)){tt("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Ne=je.get(R).__webglFramebuffer;if(R.isWebGLCubeRenderTarget&&ze!==void 0&&(Ne=Ne[ze],Array.isArray(Ne)&&(Ne=Ne[0])),Ne){Le.bindFramebuffer(W.FRAMEBUFFER,Ne);try{let Ge=R.textures[Te],it=Ge.format,ft=Ge.type;R.textures.length>1&&W.readBuffer(W.COLOR_ATTACHMENT0+Te);let Ve=jr(Ge);if(Ve.__formatReadable===!1){tt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Ve.__typeReadable===!1){tt("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}V>=0&&V<=R.width-K&&te>=0&&te<=R.height-$&&W.readPixels(V,te,K,$,we.convert(it),we.convert(ft),Ie)}finally{let Ge=Se!==null?je.get(Se).__webglFramebuffer:null;Le.bindFramebuffer(W.FRAMEBUFFER,Ge)}}},this.readRenderTargetPixelsAsync=async function(R,V,te,K,$,Ie,ze,Te=0){if(!(R&&R.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Ne=je.get(R).__webglFramebuffer;if(R.isWebGLCubeRenderTarget&&ze!==void 0&&(Ne=Ne[ze],Array.isArray(Ne)&&(Ne=Ne[0])),Ne)if(V>=0&&V<=R.width-K&&te>=0&&te<=R.height-$){Le.bindFramebuffer(W.FRAMEBUFFER,Ne);let Ge=R.textures[Te],it=Ge.format,ft=Ge.type;R.textures.length>1&&W.readBuffer(W.COLOR_ATTACHMENT0+Te);let Ve=jr(Ge);if(Ve.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Ve.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let st=W.createBuffer();W.bindBuffer(W.PIXEL_PACK_BUFFER,st),W.bufferData(W.PIXEL_PACK_BUFFER,Ie.byteLength,W.STREAM_READ),W.readPixels(V,te,K,$,we.convert(it),we.convert(ft),0),W.bindBuffer(W.PIXEL_PACK_BUFFER,null);let Ht=Se!==null?je.get(Se).__webglFramebuffer:null;Le.bindFramebuffer(W.FRAMEBUFFER,Ht);let ke=W.fenceSync(W.SYNC_GPU_COMMANDS_COMPLETE,0);return W.flush(),await Zu(W,ke,4),W.bindBuffer(W.PIXEL_PACK_BUFFER,st),W.getBufferSubData(W.PIXEL_PACK_BUFFER,0,Ie),W.bindBuffer(W.PIXEL_PACK_BUFFER,null),W.deleteBuffer(st),W.deleteSync(ke),Ie}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(R,V=null,te=0){let K=Math.pow(2,-te),$=Math.floor(R.image.width*K),Ie=Math.floor(R.image.height*K),ze=V!==null?V.x:0,Te=V!==null?V.y:0;Ze.setTexture2D(R,0),W.copyTexSubImage2D(W.TEXTURE_2D,te,0,0,ze,Te,$,Ie),Le.unbindTexture()},this.copyTextureToTexture=function(R,V,te=null,K=null,$=0,Ie=0){let ze,Te,Ne,Ge,it,ft,Ve,st,Ht,ke=R.isCompressedTexture?R.mipmaps[Ie]:R.image;if(te!==null)ze=te.max.x-te.min.x,Te=te.max.y-te.min.y,Ne=te.isBox3?te.max.z-te.min.z:1,Ge=te.min.x,it=te.min.y,ft=te.isBox3?te.min.z:0;else{let M=Math.pow(2,-$);ze=Math.floor(ke.width*M),Te=Math.floor(ke.height*M),R.isDataArrayTexture?Ne=ke.depth:R.isData3DTexture?Ne=Math.floor(ke.depth*M):Ne=1,Ge=0,it=0,ft=0}K!==null?(Ve=K.x,st=K.y,Ht=K.z):(Ve=0,st=0,Ht=0);let Pt=we.convert(V.format),$t=we.convert(V.type),He;V.isData3DTexture?(Ze.setTexture3D(V,0),He=W.TEXTURE_3D):V.isDataArrayTexture||V.isCompressedArrayTexture?(Ze.setTexture2DArray(V,0),He=W.TEXTURE_2D_ARRAY):(Ze.setTexture2D(V,0),He=W.TEXTURE_2D),Le.activeTexture(W.TEXTURE0),Le.pixelStorei(W.UNPACK_FLIP_Y_WEBGL,V.flipY),Le.pixelStorei(W.UNPACK_PREMULTIPLY_ALPHA_WEBGL,V.premultiplyAlpha),Le.pixelStorei(W.UNPACK_ALIGNMENT,V.unpackAlignment);let tn=Le.getParameter(W.UNPACK_ROW_LENGTH),St=Le.getParameter(W.UNPACK_IMAGE_HEIGHT),Zn=Le.getParameter(W.UNPACK_SKIP_PIXELS),nn=Le.getParameter(W.UNPACK_SKIP_ROWS),wi=Le.getParameter(W.UNPACK_SKIP_IMAGES);Le.pixelStorei(W.UNPACK_ROW_LENGTH,ke.width),Le.pixelStorei(W.UNPACK_IMAGE_HEIGHT,ke.height),Le.pixelStorei(W.UNPACK_SKIP_PIXELS,Ge),Le.pixelStorei(W.UNPACK_SKIP_ROWS,it),Le.pixelStorei(W.UNPACK_SKIP_IMAGES,ft);let Jn=R.isDataArrayTexture||R.isData3DTexture,Kn=V.isDataArrayTexture||V.isData3DTexture;if(R.isDepthTexture){let M=je.get(R),ht=je.get(V),wn=je.get(M.__renderTarget),It=je.get(ht.__renderTarget);Le.bindFramebuffer(W.READ_FRAMEBUFFER,wn.__webglFramebuffer),Le.bindFramebuffer(W.DRAW_FRAMEBUFFER,It.__webglFramebuffer);for(let Ot=0;Ot<Ne;Ot++)Jn&&(W.framebufferTextureLayer(W.READ_FRAMEBUFFER,W.COLOR_ATTACHMENT0,je.get(R).__webglTexture,$,ft+Ot),W.framebufferTextureLayer(W.DRAW_FRAMEBUFFER,W.COLOR_ATTACHMENT0,je.get(V).__webglTexture,Ie,Ht+Ot)),W.blitFramebuffer(Ge,it,Ge+ze,it+Te,Ve,st,Ve+ze,st+Te,W.DEPTH_BUFFER_BIT,W.NEAREST);Le.bindFramebuffer(W.READ_FRAMEBUFFER,null),Le.bindFramebuffer(W.DRAW_FRAMEBUFFER,null)}else if($!==0||R.isRenderTargetTexture||je.has(R)){let M=je.get(R),ht=je.get(V);Le.bindFramebuffer(W.READ_FRAMEBUFFER,z),Le.bindFramebuffer(W.DRAW_FRAMEBUFFER,ie);for(let wn=0;wn<Ne;wn++)Jn?W.framebufferTextureLayer(W.READ_FRAMEBUFFER,W.COLOR_ATTACHMENT0,M.__webglTexture,$,ft+wn):W.framebufferTexture2D(W.READ_FRAMEBUFFER,W.COLOR_ATTACHMENT0,W.TEXTURE_2D,M.__webglTexture,$),Kn?W.framebufferTextureLayer(W.DRAW_FRAMEBUFFER,W.COLOR_ATTACHMENT0,ht.__webglTexture,Ie,Ht+wn):W.framebufferTexture2D(W.DRAW_FRAMEBUFFER,W.COLOR_ATTACHMENT0,W.TEXTURE_2D,ht.__webglTexture,Ie),$!==0?W.blitFramebuffer(Ge,it,Ge+ze,it+Te,Ve,st,Ve+ze,st+Te,W.COLOR_BUFFER_BIT,W.NEAREST):Kn?W.copyTexSubImage3D(He,Ie,Ve,st,Ht+wn,Ge,it,ze,Te):W.copyTexSubImage2D(He,Ie,Ve,st,Ge,it,ze,Te);Le.bindFramebuffer(W.READ_FRAMEBUFFER,null),Le.bindFramebuffer(W.DRAW_FRAMEBUFFER,null)}else Kn?R.isDataTexture||R.isData3DTexture?W.texSubImage3D(He,Ie,Ve,st,Ht,ze,Te,Ne,Pt,$t,ke.data):V.isCompressedArrayTexture?W.compressedTexSubImage3D(He,Ie,Ve,st,Ht,ze,Te,Ne,Pt,ke.data):W.texSubImage3D(He,Ie,Ve,st,Ht,ze,Te,Ne,Pt,$t,ke):R.isDataTexture?W.texSubImage2D(W.TEXTURE_2D,Ie,Ve,st,ze,Te,Pt,$t,ke.data):R.isCompressedTexture?W.compressedTexSubImage2D(W.TEXTURE_2D,Ie,Ve,st,ke.width,ke.height,Pt,ke.data):W.texSubImage2D(W.TEXTURE_2D,Ie,Ve,st,ze,Te,Pt,$t,ke);Le.pixelStorei(W.UNPACK_ROW_LENGTH,tn),Le.pixelStorei(W.UNPACK_IMAGE_HEIGHT,St),Le.pixelStorei(W.UNPACK_SKIP_PIXELS,Zn),Le.pixelStorei(W.UNPACK_SKIP_ROWS,nn),Le.pixelStorei(W.UNPACK_SKIP_IMAGES,wi),Ie===0&&V.generateMipmaps===!0&&V.mipmapsAutoUpdate===!0&&W.generateMipmap(He),Le.unbindTexture()},this.initRenderTarget=function(R){je.get(R).__webglFramebuffer===void 0&&Ze.setupRenderTarget(R)},this.initTexture=function(R){R.isCubeTexture?Ze.setTextureCube(R,0):R.isData3DTexture?Ze.setTexture3D(R,0):R.isDataArrayTexture||R.isCompressedArrayTexture?Ze.setTexture2DArray(R,0):Ze.setTexture2D(R,0),Le.unbindTexture()},this.resetState=function(){G=0,ne=0,Se=null,Le.reset(),Ae.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Nn}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=yt._getDrawingBufferColorSpace(e),t.unpackColorSpace=yt._getUnpackColorSpace()}};var Ud={type:"change"},qc={type:"start"},Bd={type:"end"},sl=new Li,Od=new gn,VM=Math.cos(70*Ic.DEG2RAD),Kt=new j,En=2*Math.PI,wt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},$c=1e-6,al=class extends Ls{constructor(e,t=null){super(e,t),this.state=wt.NONE,this.target=new j,this.cursor=new j,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:ki.ROTATE,MIDDLE:ki.DOLLY,RIGHT:ki.PAN},this.touches={ONE:zi.ROTATE,TWO:zi.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new j,this._lastQuaternion=new Rn,this._lastTargetPosition=new j,this._quat=new Rn().setFromUnitVectors(e.up,new j(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new kr,this._sphericalDelta=new kr,this._scale=1,this._panOffset=new j,this._rotateStart=new et,this._rotateEnd=new et,this._rotateDelta=new et,this._panStart=new et,this._panEnd=new et,this._panDelta=new et,this._dollyStart=new et,this._dollyEnd=new et,this._dollyDelta=new et,this._dollyDirection=new j,this._mouse=new et,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=WM.bind(this),this._onPointerDown=HM.bind(this),this._onPointerUp=XM.bind(this),this._onContextMenu=KM.bind(this),this._onMouseWheel=YM.bind(this),this._onKeyDown=jM.bind(this),this._onTouchStart=ZM.bind(this),this._onTouchMove=JM.bind(this),this._onMouseDown=$M.bind(this),this._onMouseMove=qM.bind(this),this._interceptControlDown=QM.bind(this),this._interceptControlUp=eb.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=wt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Ud),this.update(),this.state=wt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Kt.copy(t).sub(this.target),Kt.applyQuaternion(this._quat),this._spherical.setFromVector3(Kt),this.autoRotate&&this.state===wt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=En:n>Math.PI&&(n-=En),s<-Math.PI?s+=En:s>Math.PI&&(s-=En),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let o=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let c=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),o=c!=this._spherical.radius}if(Kt.setFromSpherical(this._spherical),Kt.applyQuaternion(this._quatInverse),t.copy(this.target).add(Kt),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let c=null;if(this.object.isPerspectiveCamera){let u=Kt.length();c=this._clampDistance(u*this._scale);let f=u-c;this.object.position.addScaledVector(this._dollyDirection,f),this.object.updateMatrixWorld(),o=!!f}else if(this.object.isOrthographicCamera){let u=new j(this._mouse.x,this._mouse.y,0);u.unproject(this.object);let f=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),o=f!==this.object.zoom;let d=new j(this._mouse.x,this._mouse.y,0);d.unproject(this.object),this.object.position.sub(d).add(u),this.object.updateMatrixWorld(),c=Kt.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;c!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(c).add(this.object.position):(sl.origin.copy(this.object.position),sl.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(sl.direction))<VM?this.object.lookAt(this.target):(Od.setFromNormalAndCoplanarPoint(this.object.up,this.target),sl.intersectPlane(Od,this.target))))}else if(this.object.isOrthographicCamera){let c=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),c!==this.object.zoom&&(this.object.updateProjectionMatrix(),o=!0)}return this._scale=1,this._performCursorZoom=!1,o||this._lastPosition.distanceToSquared(this.object.position)>$c||8*(1-this._lastQuaternion.dot(this.object.quaternion))>$c||this._lastTargetPosition.distanceToSquared(this.target)>$c?(this.dispatchEvent(Ud),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?En/60*this.autoRotateSpeed*e:En/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Kt.setFromMatrixColumn(t,0),Kt.multiplyScalar(-e),this._panOffset.add(Kt)}_panUp(e,t){this.screenSpacePanning===!0?Kt.setFromMatrixColumn(t,1):(Kt.setFromMatrixColumn(t,0),Kt.crossVectors(this.object.up,Kt)),Kt.multiplyScalar(e),this._panOffset.add(Kt)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Kt.copy(s).sub(this.target);let o=Kt.length();o*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*o/n.clientHeight,this.object.matrix),this._panUp(2*t*o/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=e-n.left,o=t-n.top,c=n.width,u=n.height;this._mouse.x=s/c*2-1,this._mouse.y=-(o/u)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(En*this._rotateDelta.x/t.clientHeight),this._rotateUp(En*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(En*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-En*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(En*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-En*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(n,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,o=Math.sqrt(n*n+s*s);this._dollyStart.set(0,o)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let n=this._getSecondPointerPosition(e),s=.5*(e.pageX+n.x),o=.5*(e.pageY+n.y);this._rotateEnd.set(s,o)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(En*this._rotateDelta.x/t.clientHeight),this._rotateUp(En*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,o=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,o),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let c=(e.pageX+t.x)*.5,u=(e.pageY+t.y)*.5;this._updateZoomParameters(c,u)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new et,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function HM(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function WM(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function XM(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(Bd),this.state=wt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function $M(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case ki.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=wt.DOLLY;break;case ki.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=wt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=wt.ROTATE}break;case ki.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=wt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=wt.PAN}break;default:this.state=wt.NONE}this.state!==wt.NONE&&this.dispatchEvent(qc)}function qM(i){switch(this.state){case wt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case wt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case wt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function YM(i){this.enabled===!1||this.enableZoom===!1||this.state!==wt.NONE||(i.preventDefault(),this.dispatchEvent(qc),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(Bd))}function jM(i){this.enabled!==!1&&this._handleKeyDown(i)}function ZM(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case zi.ROTATE:if(this.enableRotate===!1){this.state=wt.NONE;break}this._handleTouchStartRotate(i),this.state=wt.TOUCH_ROTATE;break;case zi.PAN:if(this.enablePan===!1){this.state=wt.NONE;break}this._handleTouchStartPan(i),this.state=wt.TOUCH_PAN;break;default:this.state=wt.NONE}break;case 2:switch(this.touches.TWO){case zi.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=wt.TOUCH_DOLLY_PAN;break;case zi.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=wt.TOUCH_DOLLY_ROTATE;break;default:this.state=wt.NONE}break;default:this.state=wt.NONE}this.state!==wt.NONE&&this.dispatchEvent(qc)}function JM(i){switch(this._trackPointer(i),this.state){case wt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case wt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case wt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case wt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=wt.NONE}}function KM(i){this.enabled!==!1&&i.preventDefault()}function QM(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function eb(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var Yc=.5,jc=12,tb=.2,nb=.1,ib=2;function rb(i,e,[t,n,s]){let o=c=>i.mjtGeom[`mjGEOM_${c}`].value;switch(e){case o("SPHERE"):return new Or(t,32,16);case o("CAPSULE"):return new xs(t,2*n,8,24).rotateX(Math.PI/2);case o("CYLINDER"):return new Ms(t,t,2*n,32).rotateX(Math.PI/2);case o("BOX"):return new Ni(2*t,2*n,2*s);case o("ELLIPSOID"):return new Or(1,32,16).scale(t,n,s);default:return null}}function sb(i,e){let t=new Uint8Array([i,e,e,i].flatMap(s=>[...s,255])),n=new Nr(t,2,2);return n.wrapS=n.wrapT=Ar,n.repeat.setScalar(jc/Yc),n.colorSpace=dn,n.generateMipmaps=!0,n.minFilter=Hn,n.anisotropy=8,n.needsUpdate=!0,n}var ab={light:{sky:16054008,squares:[[232,235,239],[217,222,227]],shadow:.28,sun:1.9,air:1.7},dark:{sky:1382686,squares:[[38,44,51],[29,34,40]],shadow:.6,sun:1.7,air:1}},ol=class{constructor(e,t){this.mujoco=e,this.renderer=new nl({antialias:!0}),this.renderer.setPixelRatio(Math.min(devicePixelRatio,2)),this.renderer.shadowMap.enabled=!0,this.canvas=this.renderer.domElement,t.append(this.canvas),this.camera=new _n(45,1,.05,60),this.camera.up.set(0,0,1),this.controls=new al(this.camera,this.canvas),this.controls.enableZoom=this.controls.enablePan=!1,this.canvas.style.touchAction="pan-y",this.scene=new fs,this.robot=new ri,this.air=new Rs(16777215,9080728,1),this.sun=new Is(16777215,1),this.sun.castShadow=!0,this.sun.shadow.mapSize.setScalar(1024),this.sun.shadow.normalBias=.02;let n={left:-3,right:3,top:3,bottom:-3,near:1,far:16};Object.assign(this.sun.shadow.camera,n),this.ground=new ri;let s=new Ss(jc,64);this.floor=new Mn(s,new Fr),this.shade=new Mn(s,new Es),this.shade.position.z=.001,this.shade.receiveShadow=!0,this.ground.add(this.floor,this.shade);let o=new Ur({color:13715803,depthTest:!1}),c=new j;this.pull=new gs(new yn().setFromPoints([c,c]),o),this.pull.frustumCulled=!1,this.pull.renderOrder=1,this.scene.add(this.robot,this.air,this.sun,this.sun.target,this.ground,this.pull),new ResizeObserver(()=>this.resize(t)).observe(t),this.resize(t)}resize({clientWidth:e,clientHeight:t}){!e||!t||(this.renderer.setSize(e,t),this.camera.aspect=e/t,this.camera.updateProjectionMatrix())}theme(e){let{sky:t,squares:n,shadow:s,sun:o,air:c}=ab[e];this.scene.background=new ct(t),this.scene.fog=new ds(t,5,jc),this.floor.material.map?.dispose(),this.floor.material.map=sb(...n),this.floor.material.needsUpdate=!0,this.shade.material.opacity=s,this.sun.intensity=o,this.air.intensity=c}load(e,t){let{mujoco:n,robot:s}=this;for(let S of s.children)S.geometry.dispose(),S.material.dispose();s.clear(),this.data?.delete(),this.model?.delete();let o=this.model=n.MjModel.from_xml_string(e),c=this.data=new n.MjData(o);c.qpos.set(t),n.mj_forward(o,c),this.ground.position.z=0;for(let S=0;S<o.ngeom;S++)this.geometry(S);let u=new j(...c.cam_xpos.slice(0,3)),[,,f,,,d,,,m]=c.cam_xmat.slice(0,9),y=new j(-f,-d,-m);this.root=new j(...c.xpos.slice(3,6)),this.follows=o.cam_mode[0]!==n.mjtCamLight.mjCAMLIGHT_FIXED.value,this.camera.fov=o.cam_fovy[0],this.camera.updateProjectionMatrix(),this.camera.position.copy(u);let g=this.root.clone().sub(u).dot(y);Object.assign(this,{rest:this.root.z,lift:0,band:tb*g}),this.controls.target.copy(u).addScaledVector(y,g),this.controls.maxPolarAngle=Math.PI/2,this.controls.update()}geometry(e){let{mujoco:t,model:n}=this;if(n.geom_group[e]>ib)return;if(n.geom_type[e]===t.mjtGeom.mjGEOM_PLANE.value){this.ground.position.z=n.geom_pos[3*e+2];return}let s=rb(t,n.geom_type[e],n.geom_size.slice(3*e,3*e+3));if(!s)return;let o=n.geom_matid[e],[c,u,f,d]=o<0?n.geom_rgba.slice(4*e,4*e+4):n.mat_rgba.slice(4*o,4*o+4),m=new ws({color:new ct().setRGB(c,u,f,dn),roughness:.55,metalness:.05,opacity:d,transparent:d<1,polygonOffset:!0,polygonOffsetFactor:e%7,polygonOffsetUnits:e%7}),y=new Mn(s,m);y.castShadow=y.receiveShadow=!0,y.matrixAutoUpdate=!1,y.userData={geom:e,body:n.geom_bodyid[e]},this.robot.add(y)}pose(e){let{mujoco:t,model:n,data:s,controls:o,camera:c,ground:u,sun:f}=this;s.qpos.set(e),t.mj_kinematics(n,s);let{geom_xpos:d,geom_xmat:m}=s;for(let E of this.robot.children){let C=3*E.userData.geom,x=9*E.userData.geom;E.matrix.set(m[x],m[x+1],m[x+2],d[C],m[x+3],m[x+4],m[x+5],d[C+1],m[x+6],m[x+7],m[x+8],d[C+2],0,0,0,1),E.matrixWorldNeedsUpdate=!0}let y=new j(...s.xpos.slice(3,6)),g=this.follows?y.clone().sub(this.root):new j;this.follows&&(g.z=this.lifted(y.z-this.rest)-this.lift,this.lift+=g.z),c.position.add(g),o.target.add(g),this.root=y,o.update();let S=E=>2*Yc*Math.round(E/(2*Yc));u.position.set(S(y.x),S(y.y),u.position.z),f.target.position.copy(o.target),f.position.copy(o.target).add(new j(-1.5,-2.5,6)),c.updateMatrixWorld()}lifted(e){return e-(1-nb)*Math.min(Math.max(e,-this.band),this.band)}draw(e){this.pull.visible=!!e,e&&this.pull.geometry.setFromPoints([e.at,e.to]),this.renderer.render(this.scene,this.camera)}ray({clientX:e,clientY:t}){let n=this.canvas.getBoundingClientRect(),s=(e-n.left)/n.width,o=(t-n.top)/n.height,c=new Ds;return c.setFromCamera(new et(2*s-1,1-2*o),this.camera),c}hit(e){let[t]=this.ray(e).intersectObjects(this.robot.children),n=t?.object.userData.body;return n?{body:n,local:t.point.clone().applyMatrix4(this.frame(n).invert())}:null}grip({body:e,local:t},n){let s=t.clone().applyMatrix4(this.frame(e)),o=this.camera.getWorldDirection(new j),c=new gn().setFromNormalAndCoplanarPoint(o,s),u=this.ray(n).ray.intersectPlane(c,new j)??s;return{at:s,to:u}}frame(e){let{xpos:t,xmat:n}=this.data,s=3*e,o=9*e;return new Lt().set(n[o],n[o+1],n[o+2],t[s],n[o+3],n[o+4],n[o+5],t[s+1],n[o+6],n[o+7],n[o+8],t[s+2],0,0,0,1)}window(e){let t=this.canvas.getBoundingClientRect(),n=e.clone().project(this.camera);return{x:t.left+(1+n.x)/2*t.width,y:t.top+(1-n.y)/2*t.height}}};var ob={relu:i=>Math.max(i,0),sin:Math.sin,tanh:Math.tanh,silu:i=>i/(1+Math.exp(-i)),elu:i=>i>0?i:Math.expm1(i),clip:i=>Math.min(Math.max(i,-1),1)};function lb({mean:i,scale:e,sizes:t,activation:n,squash:s,weights:o}){let c=Uint8Array.from(atob(o),d=>d.charCodeAt(0)),u=new Float32Array(c.buffer),f=[];for(let d=1,m=0;d<t.length;d++){let y=t[d-1],g=t[d],S=u.subarray(m,m+y*g),E=u.subarray(m+y*g,m+y*g+g);m+=y*g+g;let C=ob[d<t.length-1?n:s];f.push({n:y,m:g,W:S,b:E,f:C})}return d=>{let m=d.map((y,g)=>(y-i[g])/e[g]);for(let{n:y,m:g,W:S,b:E,f:C}of f){let x=Array.from(E);for(let v=0;v<y;v++)for(let P=0;P<g;P++)x[P]+=m[v]*S[v*g+P];m=x.map(C)}return m}}var $s=class{constructor(e,t){this.mujoco=e,this.definition=t,this.act=lb(t.policy),t.models.physics&&(this.model=e.MjModel.from_xml_string(t.models.physics),this.data=new e.MjData(this.model),this.mass=this.model.body_mass.reduce((n,s)=>n+s)),this.reset(0)}reset(e){let{starts:t}=this.definition,{s:n,o:s}=t[e%t.length];Object.assign(this,{s:n,o:s,reward:0,total:0,ended:!1,decisions:0})}physics=(e,t,n=[])=>{let{model:s,data:o,mujoco:c}=this,{nq:u,nv:f,na:d,nu:m}=s,y=0,g={qpos:u,qvel:f,act:d,qacc_warmstart:f,ctrl:m};for(let[E,C]of Object.entries(g))C&&o[E].set(e.slice(y,y+C).map(Math.fround)),y+=C;o.xfrc_applied.fill(0),this.push&&this.pushed(this.push);for(let E=0;E<t;E++)c.mj_step(s,o);return n.length&&c.mj_forward(s,o),["qpos","qvel","act","qacc_warmstart",...n].flatMap(E=>[...o[E]]).map(Math.fround)};pushed({body:e,at:t,force:[n,s,o]}){let{xipos:c,xfrc_applied:u}=this.data,[f,d,m]=t.map((g,S)=>g-c[3*e+S]),y=[d*o-m*s,m*n-f*o,f*s-d*n];u.set([n,s,o,...y],6*e)}decide(){this.told&&Object.assign(this,this.definition.tell(this.s,this.o,this.told));let e=this.act(this.o);this.reward=0,this.ended=!1;for(let t=0;t<this.definition.repeat&&!this.ended;t++){let{s:n,o:s,reward:o,ended:c}=this.definition.step(this.s,e,this.physics);Object.assign(this,{s:n,o:s,ended:!!c}),this.reward+=o}this.total+=this.reward,this.decisions+=1}get pose(){return this.definition.pose(this.s)}episode(e,t=0){this.reset(e);let n=[this.o],s=[];for(;!this.ended&&this.decisions<this.definition.limit;)this.decide(),!(this.decisions>t)&&(n.push(this.o),s.push(this.reward));return{seen:n,rewards:s,total:this.total,decisions:this.decisions}}free(){this.data?.delete(),this.model?.delete()}};var cb=.1,hb=2,ub=3,db=.2,fb=40,pb=9.81;async function mb(){let i=Uint8Array.from(atob(window.MUJOCO_WASM_GZ),t=>t.charCodeAt(0)),e=new Blob([i]).stream().pipeThrough(new DecompressionStream("gzip"));return zh({wasmBinary:await new Response(e).arrayBuffer()})}var Jc=class{constructor(e,t){this.mujoco=e,this.root=t,this.stage=Yn("div","robots-stage"),this.picture=new ol(e,this.stage),this.status=Yn("output","robots-status",""),this.command=Yn("code","",""),this.hint=Yn("p","robots-hint",""),this.buttons=Object.entries(window.ROBOTS).map(([c,{title:u}])=>Zc(u,()=>this.show(c),{name:c})),this.pauseButton=Zc("Pause",()=>this.pause(!this.paused));let n=Yn("div","robots-bar",...this.buttons),s=Yn("div","robots-bar",this.pauseButton,Zc("Reset",()=>this.restart(this.start+1)),this.status);this.commands=Yn("div","robots-bar");let o=Yn("p","robots-hint","The same in Python: ",this.command);t.replaceChildren(n,this.stage,this.commands,s,this.hint,o),this.listen(),this.theme()}show(e){this.world?.free(),this.name=e;let t=window.ROBOTS[e];this.world=new $s(this.mujoco,t),this.stats={name:e,time:0,decisions:0,pushes:0,falls:0,x:0,z:0},this.grabbed=null,this.restart(0),this.listenToCommands(t.commands??{}),this.picture.load(t.models.scene,this.world.pose);for(let s of this.buttons)s.setAttribute("aria-pressed",s.dataset.name===e);this.picture.canvas.setAttribute("aria-label",`${t.title}, simulated`),this.command.textContent=`python -m hybrid_rl.render policy=${e}`;let n=this.world.model?"Drag the robot to pull at it. ":"";this.hint.textContent=`${n}Drag beside it to turn the view.`,this.pause(!1)}listenToCommands(e){let t=Object.entries(e).map(([o,c])=>{let u=Yn("input","");return Object.assign(u,{type:"range",min:-c,max:c,step:c/20,value:0}),u.addEventListener("input",()=>{this.world.told=t.map(f=>Number(f.value))}),u}),n=Object.keys(e),s=t.map((o,c)=>Yn("label","",n[c]," ",o));this.commands.replaceChildren(...s)}restart(e){this.start=e,this.world.reset(e),this.before=this.after=this.world.pose,this.fraction=this.down=this.still=0,this.from=this.after[0]}pause(e){this.paused=e,this.pauseButton.textContent=e?"Run":"Pause"}decide(){let{world:e,stats:t}=this,{dt:n,repeat:s,travels:o,limit:c}=e.definition;e.push=this.grabbed?this.force():null,e.decide(),this.before=this.after,this.after=e.pose;let u=n*s,[f]=this.after;t.time+=u,t.decisions+=1,this.down=e.ended?this.down+u:0,this.still=Math.abs(f-this.from)<db?this.still+u:0,this.still||(this.from=f),(this.down>hb||(o?this.still>ub:e.decisions>=c))&&!this.grabbed&&(t.falls+=Number(o||e.ended),this.restart(this.start+1))}force(){let{at:e,to:t}=this.picture.grip(this.grabbed,this.pointer),n=t.clone().sub(e).multiplyScalar(fb*this.world.mass);return n.clampLength(0,pb*this.world.mass),this.stats.pushes+=1,{body:this.grabbed.body,at:e.toArray(),force:n.toArray()}}frame(e){let{world:t,picture:n,stats:s}=this,o=Math.min((e-this.last)/1e3,cb);if(this.last=e,!this.paused){let{dt:f,repeat:d}=t.definition;for(this.fraction+=o/(f*d);this.fraction>=1;this.fraction-=1)this.decide()}let c=this.after.map((f,d)=>this.before[d]+this.fraction*(f-this.before[d]));n.pose(c),n.draw(this.grabbed&&n.grip(this.grabbed,this.pointer)),Object.assign(s,{x:n.root.x,z:n.root.z});let u=Math.round(t.total).toLocaleString("en");this.status.textContent=`decision ${t.decisions.toLocaleString("en")}, return ${u}`}theme(){let e=document.body.dataset.theme,t=matchMedia("(prefers-color-scheme: dark)").matches;this.picture.theme(e==="dark"||e!=="light"&&t?"dark":"light")}listen(){let{stage:e,picture:t}=this,n=()=>{this.grabbed=null};e.addEventListener("pointerdown",o=>{this.pointer=o,this.grabbed=this.world.model?t.hit(o):null,this.grabbed?.body>=this.world.model?.nbody&&n(),this.grabbed&&(o.stopPropagation(),e.setPointerCapture(o.pointerId))},{capture:!0}),e.addEventListener("pointermove",o=>{this.pointer=o});for(let o of["pointerup","pointercancel","lostpointercapture"])e.addEventListener(o,n);e.addEventListener("touchstart",o=>{this.world.model&&t.hit(o.touches[0])&&o.preventDefault()},{passive:!1}),new MutationObserver(()=>this.theme()).observe(document.body,{attributeFilter:["data-theme"]}),matchMedia("(prefers-color-scheme: dark)").addEventListener("change",()=>this.theme()),new IntersectionObserver(([o])=>{this.visible=o.isIntersecting,this.visible&&this.run()}).observe(e)}run(){if(this.running)return;this.running=!0;let e=t=>{this.running=this.visible,this.visible&&(this.frame(t),requestAnimationFrame(e))};requestAnimationFrame(t=>{this.last=t,e(t)})}};function Yn(i,e,...t){let n=document.createElement(i);return e&&(n.className=e),n.append(...t),n}function Zc(i,e,t={}){let n=Yn("button","",i);return n.type="button",Object.assign(n.dataset,t),n.addEventListener("click",e),n}window.runRobots=async i=>{let e=new Jc(await mb(),i);return e.World=$s,e.show(Object.keys(window.ROBOTS)[0]),e};})();
